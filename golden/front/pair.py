"""What both models demand of a stereo pair."""

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.config import CHANNELS
from softdepth.spec.errors import InputError

Image = NDArray[np.uint8]
"""HxWx3 uint8: rows, columns, and the channels red, green, blue."""


def check_pair(left: Image, right: Image) -> None:
    """Raise `InputError` unless both images are non-empty HxWx3 uint8 arrays of one shape."""
    for name, image in (("left", left), ("right", right)):
        if image.dtype != np.uint8:
            raise InputError(f"the {name} image is {image.dtype}", "give 8-bit channels (uint8)")
        if image.ndim != 3 or image.shape[2] != CHANNELS or not image.size:
            raise InputError(f"the {name} image has shape {image.shape}", "give height x width x 3 pixels")
    if left.shape != right.shape:
        (lh, lw, _), (rh, rw, _) = left.shape, right.shape
        raise InputError(
            f"the left image is {lw}x{lh}, the right image {rw}x{rh}", "give a rectified pair of one size"
        )


def check_pixel(left: Image, x: int, y: int) -> None:
    """Raise `InputError` unless (x, y) lies in the image."""
    height, width, _ = left.shape
    if not (0 <= x < width and 0 <= y < height):
        raise InputError(
            f"pixel x={x} y={y} is outside the {width}x{height} image",
            f"use x in 0..{width - 1} and y in 0..{height - 1}",
        )
