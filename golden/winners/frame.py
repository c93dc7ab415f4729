"""The winners of a frame, band by band."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.candidates import Band, bands
from softdepth.golden.costs.criteria import Values
from softdepth.golden.front.pair import Image
from softdepth.golden.winners.cost import Comparison, Cost
from softdepth.golden.winners.left import Left
from softdepth.golden.winners.neighbours import neighbours
from softdepth.golden.winners.right import Right
from softdepth.golden.winners.runner_up import runner_up
from softdepth.spec.config import Config

Array = NDArray[Any]
CostOf = Callable[[int, list[Values]], Cost]
"""From a candidate and its criteria to its cost."""


@dataclass
class Winners:
    """Of every pixel of a frame, in the core's view; rows x columns each. 0 in the border band.

    Members
    -------
    left, right : the winning candidate of the reference view's pixels, and of the other's.
    below, at, above : costs, as numbers, of the left winner's neighbours and its own.
    runner_up : the least cost of those that are neither.
    never : the number that stands for a candidate that does not take part.

    What the configuration does not ask for stays 0.
    """

    left: NDArray[np.uint16]
    right: NDArray[np.uint16]
    below: Array
    at: Array
    above: Array
    runner_up: Array
    never: Any


def winners(left: Image, right: Image, config: Config, cost: CostOf, comparison: Comparison) -> Winners:
    """Judge every pixel: `left` is the reference view, `cost` what a candidate costs."""
    shape = left.shape[:2]
    kind = np.float64 if isinstance(comparison.never, float) else np.int32
    found = Winners(
        left=np.zeros(shape, np.uint16),
        right=np.zeros(shape, np.uint16),
        below=np.zeros(shape, kind),
        at=np.zeros(shape, kind),
        above=np.zeros(shape, kind),
        runner_up=np.zeros(shape, kind),
        never=comparison.never,
    )
    for part in bands(left, right, config):
        _judge(part, config, cost, comparison, found)
    return found


def _judge(part: Band, config: Config, cost: CostOf, comparison: Comparison, found: Winners) -> None:
    place = np.s_[part.rows, part.columns]
    post = config.post
    first, second = Left(part.shape, comparison), Right(part.shape, comparison)
    numbers = bool(post.fraction_bits) or post.confidence
    volume = np.empty((0, 0, 0), found.at.dtype)
    if numbers:
        candidates = min(config.disparities, part.shape[1])
        volume = np.full((candidates, *part.shape), comparison.never, found.at.dtype)
    for d, criteria in part.candidates():
        costs = cost(d, criteria)
        first.take(d, costs)
        if post.check:
            second.take(d, costs)
        if numbers:
            volume[d, :, d:] = comparison.number(costs)
    found.left[place] = first.winner
    found.right[place] = second.winner
    if numbers:
        beside = neighbours(volume, first.winner, comparison.never)
        found.below[place], found.at[place], found.above[place] = beside
    if post.confidence:
        found.runner_up[place] = runner_up(volume, first.winner, comparison.never)
