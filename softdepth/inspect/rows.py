"""How the right view's rows lie to the left view's: an offset that may change over the image."""

from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.inspect.points import Points
from softdepth.inspect.reduced import Reduced

TRIALS = 300
TOLERANCE = 1.0
"""Rows, of the reduced pair, by which a point may miss the fit."""
FEWEST = 12
"""Points that a fit must rest on."""


@dataclass(frozen=True)
class RowFit:
    """``right row - left row = offset + across * (x / width - 0.5) + down * (y / height - 0.5)``, in pixels.

    `offset`, `across` and `down` are in rows of the original images, at the image's middle and over its whole
    width and height; `residual` is the median distance of the points from the fit.
    """

    offset: float
    across: float
    down: float
    residual: float

    @property
    def change(self) -> float:
        """By how many rows the offset in a corner departs from that in the middle, at most."""
        return (abs(self.across) + abs(self.down)) / 2

    @property
    def ends(self) -> tuple[float, float]:
        """The smallest and the largest offset in the image."""
        return self.offset - self.change, self.offset + self.change


def fit(points: Points, pair: Reduced) -> tuple[RowFit, np.ndarray] | None:
    """The fit that most points share (bool N: which), or None where it would rest on too few."""
    if len(points) < FEWEST:
        return None
    # The right view's columns: it is the right view's rows that get straightened by this.
    place = np.column_stack(
        [
            np.ones(len(points)),
            points.right[:, 0] / pair.width - 0.5,
            points.left[:, 1] / pair.height - 0.5,
        ]
    )
    rows = points.rows
    # Two starts for every trial's three points: a plane through them, and a plain offset, which even a few
    # points on one line tell.
    rng = np.random.default_rng(0)
    trios = rng.integers(0, len(points), (TRIALS, 3))
    systems = place[trios] + 1e-6 * np.eye(3)
    planes = np.linalg.solve(systems, rows[trios][:, :, None])[:, :, 0]
    planes = planes[np.abs(planes[:, 1:]).max(axis=1) < pair.height / 4]
    flat = np.zeros((TRIALS, 3))
    flat[:, 0] = rows[trios[:, 0]]
    starts = np.vstack([flat, planes])
    hits = (np.abs(rows[None] - starts @ place.T) < TOLERANCE).sum(axis=1)
    best = starts[hits.argmax()]
    chosen = np.abs(rows - place @ best) < TOLERANCE
    for _ in range(5):
        if chosen.sum() < FEWEST:
            return None
        best = np.linalg.lstsq(place[chosen], rows[chosen], rcond=None)[0]
        chosen = np.abs(rows - place @ best) < TOLERANCE
    if chosen.sum() < FEWEST:
        return None
    offset, across, down = (float(value) * pair.scale for value in best)
    residual = float(np.median(np.abs(rows - place @ best)[chosen])) * pair.scale
    return RowFit(offset, across, down, residual), chosen


def straightened(pair: Reduced, rows: RowFit) -> Reduced:
    """The pair with the right view's rows moved onto the left view's."""
    across, down = rows.across / pair.scale / pair.width, rows.down / pair.scale / pair.height
    middle = (rows.offset - (rows.across + rows.down) / 2) / pair.scale
    matrix = np.array([[1, 0, 0], [across, 1 + down, middle]])
    moved = cv2.warpAffine(
        pair.right,
        matrix,
        (pair.width, pair.height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return Reduced(pair.left, moved, pair.scale)
