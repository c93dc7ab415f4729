"""The criterion `sad`: the sum of absolute RGB differences (eq. 7), or of differences of the gradient."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.gradient import BITS, gradient
from softdepth.golden.front.luma import luma
from softdepth.golden.front.pair import Image
from softdepth.spec.criteria import GRADIENT_CAP, Sad

Planes = NDArray[Any]
"""Channels x rows x columns: an image block, one plane per channel."""


class SadValues:
    """The criterion over a frame: every window that lies inside both views.

    Parameters
    ----------
    left, right : rows x columns x channels, `left` the reference view.
    bits : of a channel.
    """

    def __init__(self, criterion: Sad, left: Image, right: Image, bits: int = BITS) -> None:
        self._criterion = criterion
        self.first_column = criterion.radius - criterion.dx
        self._views: tuple[NDArray[Any], ...] = (left, right)
        if criterion.source == "gradient":
            self._views = tuple(gradient(luma(v), GRADIENT_CAP, bits)[:, :, None] for v in self._views)

    def band(self, first: int, stop: int) -> Callable[[int], NDArray[np.int32]]:
        """The function from a candidate d to the sums of rows ``first .. stop - 1``.

        They are (stop - first) x (width - window + 1 - d): the first is that of column ``first_column + d``.
        """
        criterion = self._criterion
        rows = slice(first - criterion.radius, stop + criterion.radius)
        left, right = (_planes(view[rows]) for view in self._views)
        width = left.shape[2]
        return lambda d: sad(criterion, left[:, :, d:], right[:, :, : width - d])


def _planes(block: NDArray[Any]) -> Planes:
    return np.ascontiguousarray(block.transpose(2, 0, 1))


def sad(criterion: Sad, left: Planes, right: Planes) -> NDArray[np.int32]:
    """SAD of every full window: blocks of h x w pixels in, (h - window + 1) x (w - window + 1) out.

    ``SAD = sum over the window, and over the channels, of |left - right|``, at most `Sad.maximum_of`.
    """
    return box_sum(absolute_difference(left, right), criterion.window)


def absolute_difference(left: Planes, right: Planes) -> NDArray[np.int32]:
    """Sum over the channels of |left - right|: planes of one shape in, rows x columns out."""
    # Larger minus smaller stays within the images' type, which NumPy handles fastest.
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
