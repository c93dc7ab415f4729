"""Sums over runs of rows or columns, exact in the type of what is summed."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def down(values: Array, rows: int) -> Array:
    """Sums of every `rows` consecutive rows: h x w in, (h - rows + 1) x w out."""
    height = values.shape[0] - rows + 1
    # Sums of 1, 2, 4, .. rows are doubled up; those whose lengths add up to `rows` go one below the other.
    total, done, power, reach = None, 0, values, 1
    while True:
        if rows & reach:
            part = power[done : done + height]
            total = part if total is None else total + part
            done += reach
        if 2 * reach > rows:
            assert total is not None
            return total
        power = power[: len(power) - reach] + power[reach:]
        reach *= 2


def along(values: Array, columns: int) -> Array:
    """Sums of every `columns` consecutive columns: h x w in, h x (w - columns + 1) out."""
    return down(values.T, columns).T


def rows_with_zeros(plane: Array, first: int, stop: int) -> Array:
    """Rows ``first .. stop - 1`` of a plane; those that it does not have are 0."""
    height = len(plane)
    inside = plane[max(first, 0) : min(stop, height)]
    above, below = max(-first, 0), max(stop - height, 0)
    return np.pad(inside, ((above, below), (0, 0)))
