"""Filling: a pixel without a result is assumed to be as far away as the farther of its neighbours.

An invalid result becomes the smaller of the nearest valid ones to its left and right in the row, or the only
one. In a row without any it becomes 0.
"""

import numpy as np
from numpy.typing import NDArray

NONE = np.iinfo(np.uint16).max


def fill(values: NDArray[np.uint16], valid: NDArray[np.bool_]) -> NDArray[np.uint16]:
    """Rows x columns in and out."""
    smaller = np.minimum(_last_valid(values, valid), _last_valid(values[:, ::-1], valid[:, ::-1])[:, ::-1])
    return np.where(smaller == NONE, 0, smaller).astype(np.uint16)


def _last_valid(values: NDArray[np.uint16], valid: NDArray[np.bool_]) -> NDArray[np.uint16]:
    """For every pixel, its own value or that of the nearest valid pixel to its left, or `NONE`."""
    column = np.maximum.accumulate(np.where(valid, np.arange(values.shape[1]), -1), axis=1)
    found = np.take_along_axis(values, np.maximum(column, 0), axis=1)
    return np.where(column < 0, NONE, found).astype(np.uint16)
