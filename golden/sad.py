"""The sum of absolute RGB differences (eq. 7)."""

import numpy as np
from numpy.typing import NDArray

from softdepth.config import Sad

Planes = NDArray[np.uint8]
"""Channels x rows x columns: an image block, one plane per channel."""


def sad(criterion: Sad, left: Planes, right: Planes) -> NDArray[np.int32]:
    """SAD of every full window: blocks of h x w pixels in, (h - window + 1) x (w - window + 1) out.

    ``SAD = sum over the window, and over R, G, B, of |left - right|``, at most `criterion.maximum`.
    """
    return box_sum(absolute_difference(left, right), criterion.window, criterion.maximum)


def absolute_difference(left: Planes, right: Planes) -> NDArray[np.uint16]:
    """Sum over the channels of |left - right|: planes of one shape in, rows x columns out."""
    # Larger minus smaller stays within 8 bits, which NumPy handles fastest.
    difference = np.maximum(left, right) - np.minimum(left, right)
    return difference.sum(axis=0, dtype=np.uint16)


def box_sum(values: NDArray[np.uint16], window: int, maximum: int) -> NDArray[np.int32]:
    """Sums over every full ``window x window`` box of `values`; no sum exceeds `maximum`."""
    dtype = np.min_scalar_type(maximum)
    height, width = (n - window + 1 for n in values.shape)
    rows = values[:height].astype(dtype)
    for i in range(1, window):
        rows += values[i : i + height]
    sums = rows[:, :width].astype(np.int32)
    for i in range(1, window):
        sums += rows[:, i : i + width]
    return sums
