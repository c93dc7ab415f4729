"""The median of the 5x5 pixels around, edges replicated.

Invalid results are left unchanged and are not used as samples: of the n that count, rank ``(n - 1) // 2`` is
taken, the thirteenth of 25.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from softdepth.golden.front.edges import replicated
from softdepth.golden.post.rank import MISSING, lower_median
from softdepth.spec.post import MEDIAN_REACH

BAND_ROWS = 64


def median(values: NDArray[np.uint16], valid: NDArray[np.bool_]) -> NDArray[np.uint16]:
    """Rows x columns in and out."""
    side = 2 * MEDIAN_REACH + 1
    around = replicated(np.where(valid, values, MISSING), MEDIAN_REACH, MEDIAN_REACH)
    out = values.copy()
    for y in range(0, len(values), BAND_ROWS):
        rows = slice(y, min(y + BAND_ROWS, len(values)))
        windows = sliding_window_view(around[y : rows.stop + side - 1], (side, side))
        np.copyto(out[rows], lower_median(windows.reshape(*windows.shape[:2], -1)), where=valid[rows])
    return out
