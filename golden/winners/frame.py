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
from softdepth.golden.winners.left_winner import LeftWinner
from softdepth.golden.winners.neighbours import neighbours
from softdepth.golden.winners.right_winner import RightWinner
from softdepth.golden.winners.runner_up import runner_up
from softdepth.spec.config import Config

Array = NDArray[Any]
CostOf = Callable[[int, list[Values]], Cost]
"""From a candidate and its criteria to its cost."""


@dataclass
class Winners:
    """For every pixel of a frame, in the core's view; rows x columns each. 0 in the border band.

    Members
    -------
    left, right : the winning candidate of the reference view's pixels, and of the other's.
    below, at, above : costs, as numbers, of the left winner's neighbours and its own.
    runner_up : the least cost of those that are neither.
    never : the number that stands for a candidate that does not take part.

    Arrays that the configuration does not ask for are empty.
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
    shape, post = left.shape[:2], config.post
    kind = np.float64 if isinstance(comparison.never, float) else np.int32

    def plane(wanted: bool, kind: type) -> Array:
        return np.zeros(shape if wanted else (0, 0), kind)

    numbers = _numbers(config)
    found = Winners(
        left=plane(True, np.uint16),
        right=plane(post.check, np.uint16),
        below=plane(numbers, kind),
        at=plane(numbers, kind),
        above=plane(numbers, kind),
        runner_up=plane(post.confidence, kind),
        never=comparison.never,
    )
    for part in bands(left, right, config):
        _judge(part, config, cost, comparison, found)
    return found


def _numbers(config: Config) -> bool:
    """Whether costs around the winner are wanted."""
    return bool(config.post.fraction_bits) or config.post.confidence


def _judge(part: Band, config: Config, cost: CostOf, comparison: Comparison, found: Winners) -> None:
    place = np.s_[part.rows, part.columns]
    post = config.post
    first = LeftWinner(part.shape, comparison)
    second = RightWinner(part.shape if post.check else (0, 0), comparison)
    numbers = _numbers(config)
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
    if post.check:
        found.right[place] = second.winner
    if numbers:
        beside = neighbours(volume, first.winner, comparison.never)
        found.below[place], found.at[place], found.above[place] = beside
    if post.confidence:
        found.runner_up[place] = runner_up(volume, first.winner, comparison.never)
