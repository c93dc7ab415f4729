"""How the right view's brightness and contrast compare with the left view's, at the same points."""

from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.inspect.points import Points
from softdepth.inspect.reduced import Reduced

AROUND = 9
"""Pixels a side, around a point, over which brightness and contrast are taken."""
FEWEST = 12
"""Points that a ratio must rest on."""

_DARK, _BRIGHT = 6, 249  # a mean beyond these says more about the sensor's ends than about the light


@dataclass(frozen=True)
class Light:
    """Ratios right to left: 1 where the views agree.

    Members
    -------
    brightness, contrast : the median over the points of the ratio of means, and of standard deviations.
    uneven : half the distance between the quartiles of the brightness ratios, as a factor: 0.1 is +-10 %.
    """

    brightness: float
    contrast: float
    uneven: float


def measure(pair: Reduced, points: Points) -> Light | None:
    """Compare the views at matched points; None where there are too few."""
    (left, left_spread), (right, right_spread) = (
        _around(view, places) for view, places in ((pair.left, points.left), (pair.right, points.right))
    )
    usable = (np.minimum(left, right) > _DARK) & (np.maximum(left, right) < _BRIGHT)
    usable &= np.minimum(left_spread, right_spread) > 1
    if usable.sum() < FEWEST:
        return None
    brightness = np.log(right[usable] / left[usable])
    contrast = np.log(right_spread[usable] / left_spread[usable])
    quarter, middle, three = np.percentile(brightness, (25, 50, 75))
    return Light(
        float(np.exp(middle)), float(np.exp(np.median(contrast))), float(np.expm1((three - quarter) / 2))
    )


def _around(view: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation around each place."""
    values = view.astype(np.float32)
    mean = cv2.blur(values, (AROUND, AROUND))
    spread = np.sqrt(np.maximum(cv2.blur(values * values, (AROUND, AROUND)) - mean * mean, 0))
    height, width = view.shape
    columns = np.clip(np.rint(places[:, 0]).astype(int), 0, width - 1)
    rows = np.clip(np.rint(places[:, 1]).astype(int), 0, height - 1)
    return mean[rows, columns], spread[rows, columns]
