"""Single image files, read as those of a pair are."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from softdepth.golden.data.decode import read_raster
from softdepth.golden.data.images import bring_in


class ImageFile(NamedTuple):
    """An image as `read_image` gives it.

    Members
    -------
    pixels : H x W for gray, H x W x 3 for RGB; uint8 up to 8 bits, uint16 beyond.
    notes : what was changed on the way in, one sentence each.
    bits : bits a channel: white is ``2**bits - 1``.
    """

    pixels: np.ndarray
    notes: tuple[str, ...]
    bits: int


def read_image(path: str | Path, *, bits: int | None = None) -> ImageFile:
    """Read one file, its depth found as `read_pair` finds that of two."""
    images, notes, found = bring_in([read_raster(path)], bits)
    return ImageFile(images[0], notes, found)
