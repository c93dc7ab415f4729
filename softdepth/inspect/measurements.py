"""Everything that is measured about a pair, in one go."""

from dataclasses import dataclass

import numpy as np

from softdepth.inspect import light, points, rows, span, texture
from softdepth.inspect.reduced import Reduced


@dataclass(frozen=True)
class Measurements:
    """What a pair shows before it is matched; lengths in pixels of the images as they are.

    Members
    -------
    width, height : of the images.
    scale : pixels of the images for one of the reduced pair that was measured.
    same : left and right are one picture.
    keypoints : points found in the view that has fewer of them.
    points : those found in both views, on rows that fit each other and with neighbours that agree.
    rows : how the rows lie to each other, or None where too few points tell.
    span : the disparities, or None likewise.
    light : brightness and contrast compared, or None likewise.
    bare : share of the left image without texture.
    """

    width: int
    height: int
    scale: float
    same: bool
    keypoints: int
    points: int
    rows: rows.RowFit | None
    span: span.Span | None
    light: light.Light | None
    bare: float


def measure(left: np.ndarray, right: np.ndarray) -> Measurements:
    """Measure two uint8 images of one size, RGB or gray. Takes some 0.3 s, whatever the size."""
    pair = Reduced.of(left, right)
    matched = points.match(pair)
    fitted = rows.fit(matched, pair)
    if fitted:
        matched = matched.only(fitted[1])
        chosen = matched.only(points.supported(matched))
        straight = rows.straightened(pair, fitted[0])
    else:
        chosen, straight = matched.only(np.zeros(len(matched), bool)), pair
    return Measurements(
        width=left.shape[1],
        height=left.shape[0],
        scale=pair.scale,
        same=bool(np.array_equal(left, right)),
        keypoints=matched.found,
        points=len(chosen),
        rows=fitted[0] if fitted else None,
        span=span.measure(straight, chosen),
        light=light.measure(pair, chosen),
        bare=texture.bare(pair.left),
    )
