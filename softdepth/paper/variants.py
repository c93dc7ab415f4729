"""Float maps that no configuration of the core has: the guess at "[11]", and other compensating rules.

"[11]" is an earlier method of the paper's authors, of which it says only that it has a hard operator
in Zadeh's composition. One SAD per colour channel is the obvious meaning of three inputs.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from softdepth.config import CHANNELS, Compensation, Config, Operator
from softdepth.golden.float_model import memberships
from softdepth.golden.inference import conclusions
from softdepth.golden.operators import operator
from softdepth.golden.sad import box_sum
from softdepth.paper.readings import Reading
from softdepth.rules import weight

Array = NDArray[np.float64]
Sums = NDArray[np.int32]

BAND_ROWS = 32
"""Rows that are worked on at once, so that their planes stay in the cache."""


def disparity(
    left: np.ndarray, right: np.ndarray, reading: Reading, name: Operator, judged_by: int | None = None
) -> np.ndarray:
    """H x W uint16: the candidate of least cost, the smallest on a tie; edges replicated.

    Parameters
    ----------
    left, right : H x W x 3 uint8.
    reading : view, windows, candidates and label; its method says whether a criterion sums over
        one channel (``prototype``) or over all.
    judged_by : the window whose RGB SAD the compensating rule judges, or None: no rule.
    """
    assert reading.leaving == "replicated"
    if reading.view == "right":
        left, right = right[:, ::-1], left[:, ::-1]
    radius, far = max(reading.windows) // 2, reading.candidates - 1
    rows = (radius, radius)
    reference = np.pad(left, (rows, (radius, radius), (0, 0)), mode="edge").astype(np.int32)
    other = np.pad(right, (rows, (radius + far, radius), (0, 0)), mode="edge").astype(np.int32)
    height, width, _ = left.shape
    winner = np.zeros((height, width), np.uint16)
    for top in range(0, height, BAND_ROWS):
        found = winner[top : top + BAND_ROWS]
        part = slice(top, top + len(found) + 2 * radius)
        best = np.full(found.shape, np.inf)
        for d in range(reading.candidates):
            there = other[part, far - d : far - d + width + 2 * radius]
            costs = cost(_criteria(np.abs(reference[part] - there), reading, d, judged_by), name, reading)
            better = costs < best
            best[better] = costs[better]
            found[better] = d
    return winner[:, ::-1] if reading.view == "right" else winner


def cost(criteria: Sequence[NDArray[np.generic]], name: Operator, reading: Reading) -> Array:
    """Eq. 9, table 1 and eq. 10: the cost of three criteria, arrays of one shape.

    The softness of the operators is the default configuration's, the rule base the printed one.
    """
    fields = Config.model_fields
    theta = operator(name, delta=fields["softness"].default, k=fields["sharpness"].default)
    numerator, denominator = np.zeros(criteria[0].shape), np.zeros(criteria[0].shape)
    for k, y_k in conclusions([memberships(s, reading.label) for s in criteria], theta, "printed"):
        numerator += y_k * weight(k)
        denominator += y_k
    return np.divide(numerator, denominator, out=np.full_like(numerator, np.inf), where=denominator > 0)


def sums(difference: np.ndarray, windows: Sequence[int]) -> Mapping[int, Sums]:
    """Box sums by window: h x w differences in, (h - widest + 1) x (w - widest + 1) out for each."""
    widest = max(windows)
    found = {}
    for window in set(windows):
        skip = (widest - window) // 2
        height, width = difference.shape
        found[window] = box_sum(difference[skip : height - skip, skip : width - skip], window)
    return found


def compensated(
    criteria: Sequence[Sums], judge: Sums, d: NDArray[np.integer] | int, label: float
) -> list[NDArray[np.float64]]:
    """The compensating rule: criteria become 2T where d >= 32 and `judge` is above 1200."""
    rule = Compensation()
    fires = (np.asarray(d) >= rule.min_disparity) & (judge > rule.threshold)
    return [np.where(fires, 2 * label, s) for s in criteria]


def _criteria(
    difference: np.ndarray, reading: Reading, d: int, judged_by: int | None
) -> Sequence[NDArray[np.generic]]:
    if reading.method == "prototype":
        return [box_sum(difference[:, :, c], reading.windows[0]) for c in range(CHANNELS)]
    found = sums(difference.sum(2, dtype=np.int32), reading.windows)
    criteria = [found[window] for window in reading.windows]
    return criteria if judged_by is None else compensated(criteria, found[judged_by], d, reading.label)
