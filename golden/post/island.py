"""The island test: a result with too few valid ones around it is rejected.

Of the rows x columns of pixels around it, including the centre and with the image's edges replicated, at
least `fewest` must be valid before the test.
"""

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.sums import along, down
from softdepth.golden.front.edges import replicated

Mask = NDArray[np.bool_]


def on_an_island(valid: Mask, fewest: int, rows: int, columns: int) -> Mask:
    """Where a valid result fails the test: rows x columns."""
    around = replicated(valid.astype(np.int16), rows // 2, columns // 2)
    return valid & (along(down(around, rows), columns) < fewest)
