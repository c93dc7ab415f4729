"""Luma: the value of a pixel that census and gradient use.

``(R + 2 G + B) >> 2``, in the pixels' own bits. For gray pixels it is the pixel itself.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.pair import Image

Plane = NDArray[np.int16]
"""Rows x columns of whole numbers."""


def luma(image: Image | NDArray[Any]) -> Plane:
    """Rows x columns x channels (1 or 3, of up to 12 bits) in, rows x columns out."""
    values = image.astype(np.int16)
    if values.shape[2] == 1:
        return values[:, :, 0]
    return (values[:, :, 0] + 2 * values[:, :, 1] + values[:, :, 2]) >> 2
