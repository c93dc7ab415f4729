"""The range of disparities that a pair has, of either sign."""

from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.inspect.points import Points
from softdepth.inspect.reduced import Reduced

LONGEST_SIDE = 420
"""Pixels a side of the pair that is matched densely."""
FEWEST = 8
"""Points from which a dense match may start."""
OUTER = 0.5
"""Per cent of the pixels at either end that do not count: a match gone wrong is not a range."""

_WINDOW = 5
_AROUND = 15  # pixels a side over which brightness and contrast are evened out
_SMOOTH = 8 * _WINDOW**2  # the factors of OpenCV's samples


@dataclass(frozen=True, eq=False)
class Span:
    """Disparities in pixels of the original images.

    Members
    -------
    values : float32 N, of every pixel that found its partner.
    density : their share of the image.
    """

    values: np.ndarray
    density: float

    @property
    def low(self) -> float:
        """The smallest disparity, outliers left out."""
        return float(np.percentile(self.values, OUTER))

    @property
    def high(self) -> float:
        """The largest disparity, outliers left out."""
        return float(np.percentile(self.values, 100 - OUTER))

    def mirrored(self) -> "Span":
        """That of the views exchanged."""
        return Span(-self.values, self.density)

    def above(self, limit: float) -> float:
        """Share of the matched pixels whose disparity is more than `limit`."""
        return float((self.values > limit).mean())

    def below(self, limit: float) -> float:
        """Share of the matched pixels whose disparity is less than `limit`."""
        return float((self.values < limit).mean())


def measure(pair: Reduced, points: Points) -> Span | None:
    """Match a straightened `pair` densely, in and around the range of its matched points.

    The points alone miss what has no corners, such as a ball or a wall near the cameras. None where there
    are too few points to start from, or where hardly a pixel finds its partner.
    """
    if len(points) < FEWEST:
        return None
    small = pair.smaller(LONGEST_SIDE)
    low, high = np.percentile(points.disparity, (1, 99)) * pair.scale / small.scale
    reach = high - low
    first = int(np.floor(low - 0.25 * reach - 4))
    count = int(np.ceil((high + 0.5 * reach + 8 - first) / 16) * 16)
    matcher = cv2.StereoSGBM_create(  # pyright: ignore[reportAttributeAccessIssue]
        minDisparity=first,
        numDisparities=count,
        blockSize=_WINDOW,
        P1=_SMOOTH,
        P2=4 * _SMOOTH,
        disp12MaxDiff=1,
        uniquenessRatio=10,
        speckleWindowSize=100,
        speckleRange=1,
        preFilterCap=31,
    )
    # OpenCV leaves the columns out whose range is not all inside the image; wider images have them all.
    before, after = max(0, first + count), max(0, -first)
    views = (
        cv2.copyMakeBorder(_even(view), 0, 0, before, after, cv2.BORDER_REPLICATE)
        for view in (small.left, small.right)
    )
    disparity = matcher.compute(*views)[:, before : before + small.width].astype(np.float32) / 16
    partner = np.arange(small.width) - disparity
    good = (disparity >= first) & (partner >= 0) & (partner <= small.width - 1)
    if good.mean() < 0.01:
        return None
    return Span(disparity[good] * np.float32(small.scale), float(good.mean()))


def _even(view: np.ndarray) -> np.ndarray:
    """The view with brightness and contrast evened out, so that a lamp is no disparity."""
    values = view.astype(np.float32)
    mean = cv2.blur(values, (_AROUND, _AROUND))
    spread = np.sqrt(np.maximum(cv2.blur(values * values, (_AROUND, _AROUND)) - mean * mean, 0))
    return np.clip(128 + 50 * (values - mean) / (spread + 4), 0, 255).astype(np.uint8)
