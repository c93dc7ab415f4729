"""What both models require of a stereo pair."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import InputError
from softdepth.spec.pixel import PixelFormat

Image = NDArray[np.unsignedinteger[Any]]
"""HxWx3 red, green and blue, or HxW gray; uint8, or uint16 where a channel has more than 8 bits."""


def channel_type(pixel: PixelFormat) -> np.dtype[Any]:
    """The type of an image's channels."""
    return np.dtype(np.uint8 if pixel.bits <= 8 else np.uint16)


def check_pair(left: Image, right: Image, pixel: PixelFormat = PixelFormat.RGB8) -> None:
    """Raise `InputError` unless both images are non-empty, of one shape, and of `pixel`'s format.

    Gray images are HxW or HxWx1.
    """
    for name, image in (("left", left), ("right", right)):
        if image.dtype != channel_type(pixel):
            raise InputError(
                f"the {name} image is {image.dtype}",
                f"give {pixel.bits}-bit channels ({channel_type(pixel)})",
            )
        channels = 1 if image.ndim == 2 else image.shape[2] if image.ndim == 3 else 0
        if channels != pixel.channels or not image.size:
            wanted = "height x width x 3 pixels" if pixel.channels > 1 else "height x width gray pixels"
            raise InputError(
                f"the {name} image has shape {image.shape}", f"give {wanted}, or set pixel to what it is"
            )
        if pixel.bits % 8 and image.max() > pixel.maximum:
            raise InputError(
                f"the {name} image has a value of {image.max()}, more than the {pixel.maximum} of '{pixel}'",
                "scale it, or use a pixel format of more bits",
            )
    if left.shape != right.shape:
        (lh, lw), (rh, rw) = left.shape[:2], right.shape[:2]
        raise InputError(
            f"the left image is {lw}x{lh}, the right image {rw}x{rh}",
            "give a rectified pair of the same size",
        )


def check_pixel(left: Image, x: int, y: int) -> None:
    """Raise `InputError` unless (x, y) lies in the image."""
    height, width = left.shape[:2]
    if not (0 <= x < width and 0 <= y < height):
        raise InputError(
            f"pixel x={x} y={y} is outside the {width}x{height} image",
            f"use x in 0..{width - 1} and y in 0..{height - 1}",
        )
