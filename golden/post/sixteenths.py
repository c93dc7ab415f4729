"""Sixteenths of a pixel: two lines of equal and opposite slope through three costs.

With the costs a, c, b of d - 1, the winner d, and d + 1, and ``s = max(a, b) - c``:
``16 d + floor(8 (a - b) / s + 1 / 2)``. It is 16 d if a neighbour does not take part or s is not above 0.
Costs are numbers (`Config.number_range`).
"""

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.winners.frame import Winners

UNITS = 16


def sixteenths(found: Winners) -> NDArray[np.uint16]:
    """The left winner of every pixel in units of 1/16 pixel: rows x columns."""
    whole = UNITS * found.left.astype(np.int32)
    slope = np.maximum(found.below, found.above) - found.at
    bent = (found.below < found.never) & (found.above < found.never) & (slope > 0)
    difference, slope = found.below[bent] - found.above[bent], slope[bent]
    whole[bent] += ((UNITS * difference + slope) // (2 * slope)).astype(np.int32)
    return whole.astype(np.uint16)
