"""The sum of absolute RGB differences (eq. 7)."""

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.config import Sad

Planes = NDArray[np.uint8]
"""Channels x rows x columns: an image block, one plane per channel."""


def sad(criterion: Sad, left: Planes, right: Planes) -> NDArray[np.int32]:
    """SAD of every full window: blocks of h x w pixels in, (h - window + 1) x (w - window + 1) out.

    ``SAD = sum over the window, and over R, G, B, of |left - right|``, at most `criterion.maximum`.
    """
    return box_sum(absolute_difference(left, right), criterion.window)


def absolute_difference(left: Planes, right: Planes) -> NDArray[np.int32]:
    """Sum over the channels of |left - right|: planes of one shape in, rows x columns out."""
    # Larger minus smaller stays within 8 bits, which NumPy handles fastest.
    difference = np.maximum(left, right) - np.minimum(left, right)
    return difference.sum(axis=0, dtype=np.int32)


def box_sum(values: NDArray[np.int32], window: int) -> NDArray[np.int32]:
    """Sums over every full ``window x window`` box of `values`."""
    height, width = (n - window + 1 for n in values.shape)
    columns = values[:height].copy()
    for i in range(1, window):
        columns += values[i : i + height]
    sums = columns[:, :width].copy()
    for i in range(1, window):
        sums += columns[:, i : i + width]
    return sums
