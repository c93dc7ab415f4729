"""The island test: a result with too few valid ones around it is rejected.

Of the 5x5 pixels around it, including the centre and with the image's edges replicated, at least `fewest`
must be valid before the test.
"""

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.sums import along, down
from softdepth.golden.front.edges import replicated
from softdepth.spec.post import ISLAND_REACH

Mask = NDArray[np.bool_]


def on_an_island(valid: Mask, fewest: int) -> Mask:
    """Where a valid result fails the test: rows x columns."""
    side = 2 * ISLAND_REACH + 1
    around = replicated(valid.astype(np.int16), ISLAND_REACH, ISLAND_REACH)
    return valid & (along(down(around, side), side) < fewest)
