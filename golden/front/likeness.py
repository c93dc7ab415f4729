"""Which pixels have a similar colour, for supports and masked medians.

Two pixels are alike if they differ by less than `like` in every channel. `like` is in 8-bit values; for
pixels with more bits it is scaled, ``like << (bits - 8)``.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.gradient import BITS
from softdepth.golden.front.pair import Image

Mask = NDArray[np.bool_]


def coarse(image: Image, kept: int, bits: int = BITS) -> Image:
    """`image` with the lower bits of each channel 0, but for the `kept` highest."""
    dropped = max(bits - kept, 0)
    return (image >> dropped << dropped).astype(image.dtype)


def alike_beside(image: Image | NDArray[Any], offset: int, like: int, bits: int = BITS) -> Mask:
    """Where the pixel `offset` columns to the right lies in the image and is like the pixel itself.

    Rows x columns x channels in, rows x columns out.
    """
    height, width = image.shape[:2]
    found = np.zeros((height, width), bool)
    if abs(offset) >= width:
        return found
    here = image[:, max(-offset, 0) : width - max(offset, 0)]
    there = image[:, max(offset, 0) : width + min(offset, 0)]
    # Larger minus smaller stays within unsigned types.
    distance = (np.maximum(here, there) - np.minimum(here, there)).max(axis=2)
    found[:, max(-offset, 0) : width - max(offset, 0)] = distance < like << (bits - BITS)
    return found
