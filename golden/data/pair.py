"""A stereo pair in memory, at the depth it came with, and its conversion to a core's pixels."""

import re
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from softdepth.golden.data.inputs import size_text
from softdepth.golden.data.truth import Truth
from softdepth.spec.errors import InputError

MAX_BITS = 16
"""The most bits a channel that a pair holds."""

_FORMAT = re.compile(r"(gray|rgb)(\d{1,2})")


class Pixel(Protocol):
    """What `StereoPair.as_format` asks of a core's pixel format."""

    @property
    def channels(self) -> int: ...

    @property
    def bits(self) -> int: ...


@dataclass(frozen=True, eq=False)
class StereoPair:
    """A rectified stereo pair, and what is known about it.

    Parameters
    ----------
    left, right : two images of one size and kind: H x W for gray, H x W x 3 for RGB; uint8 up to 8 bits
        a channel, uint16 beyond.
    name : what reports call the pair.
    truth : the ground truth of the reference view, if known.
    notes : what was changed on the way in, one sentence each, worth showing to a user.
    bits : bits a channel, 1 to 16; white is ``2**bits - 1``.

    Raises
    ------
    InputError : arrays of another type or shape, values beyond `bits`, or two images that differ in
        size or in channels.
    """

    left: np.ndarray
    right: np.ndarray
    name: str
    truth: Truth | None = None
    notes: tuple[str, ...] = ()
    bits: int = 8

    def __post_init__(self) -> None:
        if not 1 <= self.bits <= MAX_BITS:
            raise InputError(f"a pair of {self.bits} bits a channel", f"use 1 to {MAX_BITS}")
        dtype = sample_type(self.bits)
        for side, image in (("left", self.left), ("right", self.right)):
            if image.dtype != dtype or image.ndim not in (2, 3) or image.shape[2:] not in ((), (3,)):
                raise InputError(
                    f"the {side} image is {image.dtype} of shape {image.shape}",
                    f"give {dtype} for {self.bits} bits: height x width gray, or height x width x 3 RGB",
                )
            if image.size and image.max() > self.maximum:
                raise InputError(
                    f"the {side} image holds {image.max()}, but {self.bits} bits end at {self.maximum}",
                    f"give bits={int(image.max()).bit_length()}",
                )
        require_same_size(self.left, self.right, "the left image", "the right image")
        if self.left.ndim != self.right.ndim:
            raise InputError("one image is gray and the other is RGB", "give two of the same kind")

    @property
    def height(self) -> int:
        """Rows."""
        return self.left.shape[0]

    @property
    def width(self) -> int:
        """Columns."""
        return self.left.shape[1]

    @property
    def channels(self) -> int:
        """1 for gray, 3 for RGB."""
        return 1 if self.left.ndim == 2 else 3

    @property
    def maximum(self) -> int:
        """The value of white."""
        return 2**self.bits - 1

    def as_format(self, pixel: Pixel | str) -> "StereoPair":
        """This pair as pixels of `pixel`: a format with `channels` and `bits`, or a name like ``gray12``.

        Gray becomes RGB by using its values three times; RGB becomes gray as ``(R + 2G + B) >> 2``, the
        luma of the models. Bits are changed by scaling, so that white stays white. Every change adds
        a note; where none is needed, the pair itself is returned.

        Raises
        ------
        InputError : a name that is no format.
        """
        channels, bits = _channels_and_bits(pixel)
        left, right, notes = self.left, self.right, list(self.notes)
        if self.channels == 3 and channels == 1:
            left, right = luma(left), luma(right)
            notes.append("the core takes gray pixels: the pair's colours become (R + 2G + B) / 4")
        if self.bits != bits:
            left, right = (rescale(image, self.maximum, bits) for image in (left, right))
            verb = "reduced" if bits < self.bits else "widened"
            notes.append(f"the pair has {self.bits} bits a channel: {verb} to the {bits} of the core")
        if self.channels == 1 and channels == 3:
            left, right = triple(left), triple(right)
            notes.append("the pair is gray, the core takes RGB: its values are used for all three channels")
        if len(notes) == len(self.notes):
            return self
        return replace(self, left=left, right=right, notes=tuple(notes), bits=bits)


def sample_type(bits: int) -> np.dtype:
    """The NumPy type of samples of so many bits."""
    return np.dtype(np.uint8 if bits <= 8 else np.uint16)


def rescale(image: np.ndarray, maximum: int, bits: int) -> np.ndarray:
    """Unsigned values ``0 .. maximum`` (at most 16 bits) as ``0 .. 2**bits - 1``, rounded to the nearest."""
    scaled = (image.astype(np.uint32) * np.uint32(2**bits - 1) + np.uint32(maximum // 2)) // np.uint32(
        maximum
    )
    return scaled.astype(sample_type(bits))


def luma(image: np.ndarray) -> np.ndarray:
    """RGB, H x W x 3, as gray, H x W: ``(R + 2G + B) >> 2``."""
    red, green, blue = (image[:, :, channel].astype(np.uint32) for channel in range(3))
    return ((red + 2 * green + blue) >> 2).astype(image.dtype)


def triple(image: np.ndarray) -> np.ndarray:
    """Gray, H x W, as RGB of equal channels, H x W x 3."""
    return np.repeat(image[:, :, np.newaxis], 3, axis=2)


def require_same_size(left: np.ndarray, right: np.ndarray, left_name: str, right_name: str) -> None:
    """Raise `InputError`, naming both, where two images differ in size."""
    if left.shape[:2] != right.shape[:2]:
        raise InputError(
            f"{left_name} is {size_text(left)}, but {right_name} is {size_text(right)}",
            "give two rectified images of the same size",
        )


def _channels_and_bits(pixel: Pixel | str) -> tuple[int, int]:
    if not isinstance(pixel, str):
        return pixel.channels, pixel.bits
    match = _FORMAT.fullmatch(pixel)
    if match is None or not 1 <= int(match[2]) <= MAX_BITS:
        raise InputError(f"'{pixel}' is not a pixel format", "use one like rgb8, gray10 or gray12")
    return {"gray": 1, "rgb": 3}[match[1]], int(match[2])
