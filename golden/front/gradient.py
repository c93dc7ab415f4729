"""The horizontal gradient: Sobel, held within +-cap.

``sum over dy in (-1, 0, 1) of (1, 2, 1) * (luma(y + dy, x + 1) - luma(y + dy, x - 1))``. Beyond the image,
its edge pixels are repeated. Luma of more than 8 bits is first cut to its upper 8.
"""

import numpy as np

from softdepth.golden.front.edges import replicated
from softdepth.golden.front.luma import Plane

BITS = 8
"""Bits of luma that the gradient is computed from."""


def gradient(luma: Plane, cap: int, bits: int = BITS) -> Plane:
    """The gradient of every pixel, of a luma of `bits` bits: rows x columns in and out."""
    around = replicated(luma >> (bits - BITS), 1, 1)
    step = around[:, 2:] - around[:, :-2]
    return np.clip(step[:-2] + 2 * step[1:-1] + step[2:], -cap, cap)
