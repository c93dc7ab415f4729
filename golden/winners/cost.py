"""Costs as winners compare them: one array (a number), or two (numerator and denominator)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Cost = tuple[Array, ...]


@dataclass(frozen=True)
class Comparison:
    """What the winners need to know about costs.

    Members
    -------
    beats : where the first cost is less than the second; a mask of their shape.
    number : the cost as one number per pixel, for fractions of a pixel and margins.
    never : a number above all those of candidates.
    """

    beats: Callable[[Sequence[Array], Sequence[Array]], NDArray[np.bool_]]
    number: Callable[[Cost], Array]
    never: Any


def less(cost: Sequence[Array], best: Sequence[Array]) -> NDArray[np.bool_]:
    """Plain numbers."""
    return cost[0] < best[0]


def less_fraction(cost: Sequence[Array], best: Sequence[Array]) -> NDArray[np.bool_]:
    """``n / s < n_best / s_best`` without a division; denominators are not negative, n / 0 is infinite."""
    return cost[0] * best[1] < best[0] * cost[1]
