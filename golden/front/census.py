"""Census: which of its neighbours are darker than a pixel.

Bit k of a pixel's 24 is set where the luma at the k-th place of `PLACES` is less than the pixel's own.
The places are the squares of a 7x7 chessboard with the colour of its centre, without the centre itself, in
raster order. Beyond the image, its edge pixels are repeated.
"""

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.edges import replicated
from softdepth.golden.front.luma import Plane

REACH = 3
PLACES = tuple(
    (dy, dx)
    for dy in range(-REACH, REACH + 1)
    for dx in range(-REACH, REACH + 1)
    if (dy + dx) % 2 == 0 and (dy, dx) != (0, 0)
)
"""Rows and columns from the pixel to the neighbour of each bit, lowest bit first."""

Census = NDArray[np.uint32]


def census(luma: Plane) -> Census:
    """The bits of every pixel: rows x columns in and out."""
    height, width = luma.shape
    around = replicated(luma, REACH, REACH)
    bits = np.zeros(luma.shape, np.uint32)
    for k, (dy, dx) in enumerate(PLACES):
        y, x = REACH + dy, REACH + dx
        darker = around[y : y + height, x : x + width] < luma
        bits |= darker.astype(np.uint32) << np.uint32(k)
    return bits
