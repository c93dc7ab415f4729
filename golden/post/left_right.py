"""The left-right check: both views must choose each other.

The winner d of pixel x is confirmed if the right winner of pixel x - d of the other view is at most
`tolerance` from d.
"""

import numpy as np
from numpy.typing import NDArray

Disparities = NDArray[np.uint16]


def consistent(left: Disparities, right: Disparities, tolerance: int) -> NDArray[np.bool_]:
    """Where the winner is confirmed: rows x columns each."""
    partner = np.arange(left.shape[1]) - left.astype(np.intp)
    other = np.take_along_axis(right, np.maximum(partner, 0), axis=1)
    return (partner >= 0) & (np.abs(left.astype(np.int32) - other) <= tolerance)
