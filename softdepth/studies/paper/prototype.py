"""A guess at the paper's "[11]": the same inference, with one criterion per colour channel.

"[11]" is an earlier method of the paper's authors, of which it says only that it has a hard operator
in Zadeh's composition. One SAD per colour channel is the obvious meaning of three inputs.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.fuzzy.inference import conclusions
from softdepth.golden.costs.fuzzy.operators import operator
from softdepth.golden.costs.sad import box_sum
from softdepth.golden.float_model import memberships
from softdepth.spec.config import Config, Operator
from softdepth.spec.rules import CONCLUSIONS, weight
from softdepth.studies.paper.readings import Reading

Array = NDArray[np.float64]

BAND_ROWS = 32
"""Rows that are worked on at once, so that their planes stay in the cache."""


def disparity(left: np.ndarray, right: np.ndarray, reading: Reading, name: Operator) -> np.ndarray:
    """H x W uint16: the candidate of least cost, the smallest on a tie; edges replicated.

    left, right : H x W x 3 uint8. `reading` gives view, window, candidates and label.
    """
    assert reading.leaving == "replicated"
    if reading.view == "right":
        left, right = right[:, ::-1], left[:, ::-1]
    window, far = reading.windows[0], reading.candidates - 1
    r = window // 2
    reference = np.pad(left, ((r, r), (r, r), (0, 0)), mode="edge").astype(np.int32)
    other = np.pad(right, ((r, r), (r + far, r), (0, 0)), mode="edge").astype(np.int32)
    height, width, _ = left.shape
    winner = np.zeros((height, width), np.uint16)
    for top in range(0, height, BAND_ROWS):
        found = winner[top : top + BAND_ROWS]
        part = slice(top, top + len(found) + 2 * r)
        best = np.full(found.shape, np.inf)
        for d in range(reading.candidates):
            difference = np.abs(reference[part] - other[part, far - d : far - d + width + 2 * r])
            sums = [box_sum(difference[:, :, channel], window) for channel in range(left.shape[2])]
            costs = cost(sums, name, reading.label)
            better = costs < best
            best[better] = costs[better]
            found[better] = d
    return winner[:, ::-1] if reading.view == "right" else winner


def cost(criteria: Sequence[NDArray[np.generic]], name: Operator, label: float) -> Array:
    """Eq. 9, table 1 and eq. 10: the cost of three criteria, arrays of one shape.

    The softness of the operators is the default configuration's, the rule base the printed one.
    """
    fields = Config.model_fields
    theta = operator(name, delta=fields["softness"].default, k=fields["sharpness"].default)
    numerator, denominator = np.zeros(criteria[0].shape), np.zeros(criteria[0].shape)
    for k, y_k in conclusions([memberships(s, label) for s in criteria], theta, "printed"):
        numerator += y_k * (weight(k) - weight(CONCLUSIONS))
        denominator += y_k
    return np.divide(numerator, denominator, out=np.full_like(numerator, np.inf), where=denominator > 0)
