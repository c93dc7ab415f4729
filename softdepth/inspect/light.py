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
    gamma : the exponent that takes the left view's brightness to the right view's, up to a factor.
    uneven : half the distance between the quartiles of what the brightness ratios depart from that gamma,
        as a factor: 0.1 is +-10 % from place to place.
    """

    brightness: float
    contrast: float
    gamma: float
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
    places, ratio = np.log(left[usable]), np.log(right[usable] / left[usable])
    contrast = np.log(right_spread[usable] / left_spread[usable])
    slope, rest = _line(places, ratio)
    quarter, three = np.percentile(rest, (25, 75))
    return Light(
        brightness=float(np.exp(np.median(ratio))),
        contrast=float(np.exp(np.median(contrast))),
        gamma=1 + slope,
        uneven=float(np.expm1((three - quarter) / 2)),
    )


def _line(places: np.ndarray, values: np.ndarray) -> tuple[float, np.ndarray]:
    """The slope of a line through most points, and how far each point lies above it."""
    kept = np.ones(len(places), bool)
    slope, rest = 0.0, values - np.median(values)
    for _ in range(3):
        if np.ptp(places[kept]) < 0.1:  # one brightness everywhere has no slope
            break
        slope, level = (float(value) for value in np.polyfit(places[kept], values[kept], 1))
        rest = values - slope * places - level
        kept = np.abs(rest) <= 2 * np.median(np.abs(rest)) + 1e-6
    return slope, rest


def _around(view: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation around each place."""
    values = view.astype(np.float32)
    mean = cv2.blur(values, (AROUND, AROUND))
    spread = np.sqrt(np.maximum(cv2.blur(values * values, (AROUND, AROUND)) - mean * mean, 0))
    height, width = view.shape
    columns = np.clip(np.rint(places[:, 0]).astype(int), 0, width - 1)
    rows = np.clip(np.rint(places[:, 1]).astype(int), 0, height - 1)
    return mean[rows, columns], spread[rows, columns]
