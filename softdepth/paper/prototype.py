"""A guess at the paper's "[11]": the same inference, with one criterion per colour channel.

The paper compares with an earlier method of its authors and says of it only that it has a hard
operator in Zadeh's composition. One SAD per channel is the obvious meaning of three inputs.
"""

import numpy as np

from softdepth.config import CHANNELS, Operator
from softdepth.golden.sad import box_sum
from softdepth.paper import fuzzy
from softdepth.paper.readings import Reading

BAND_ROWS = 32
"""Rows that are worked on at once, so that their planes stay in the cache."""


def disparity(left: np.ndarray, right: np.ndarray, reading: Reading, operator: Operator) -> np.ndarray:
    """H x W uint16: the candidate of least cost, the smallest on a tie; edges replicated.

    left, right : H x W x 3 uint8. `reading` gives view, window, candidates and label.
    """
    if reading.view == "right":
        left, right = right[:, ::-1], left[:, ::-1]
    radius = reading.windows[0] // 2
    far = reading.candidates - 1
    rows = ((radius, radius),)
    reference = np.pad(left, (*rows, (radius, radius), (0, 0)), mode="edge").astype(np.int32)
    other = np.pad(right, (*rows, (radius + far, radius), (0, 0)), mode="edge").astype(np.int32)
    height, width, _ = left.shape
    winner = np.zeros((height, width), np.uint16)
    for top in range(0, height, BAND_ROWS):
        part = slice(top, min(top + BAND_ROWS, height) + 2 * radius)
        _judge(reference[part], other[part], reading, operator, winner[top : top + BAND_ROWS])
    return winner[:, ::-1] if reading.view == "right" else winner


def _judge(
    reference: np.ndarray, other: np.ndarray, reading: Reading, operator: Operator, winner: np.ndarray
) -> None:
    """Fill `winner`, the disparities of one band of rows."""
    far = reading.candidates - 1
    width = reference.shape[1]
    best = np.full(winner.shape, np.inf)
    for d in range(reading.candidates):
        difference = np.abs(reference - other[:, far - d : far - d + width])
        sums = [box_sum(difference[:, :, c], reading.windows[0]) for c in range(CHANNELS)]
        costs = fuzzy.cost(sums, operator, reading.label)
        better = costs < best
        best[better] = costs[better]
        winner[better] = d
