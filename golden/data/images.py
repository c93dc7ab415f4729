"""Reading rectified stereo pairs from image files: `read_pair`, `read_joined`."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from softdepth.golden.data.decode import Raster, read_raster
from softdepth.golden.data.inputs import is_standard_input, size_text
from softdepth.golden.data.pair import MAX_BITS, StereoPair, require_same_size, rescale, triple
from softdepth.spec.errors import InputError

Joined = Literal["side-by-side", "top-bottom"]
"""How two views lie in one file: left and right halves, or upper (left view) and lower."""

_DEPTHS = (8, 10, 12, 14, 16)
"""Bits that a 16-bit file may really hold, as cameras have them."""

_LEAST_RANGE = 1 / 4
"""A pair that uses less of its range than this gets a note."""


def read_pair(
    left: str | Path, right: str | Path, name: str | None = None, *, bits: int | None = None
) -> StereoPair:
    """Read two image files as a pair called `name` (default: the left file's stem), at one scale.

    Depth: what the file states (8-bit files, PGM and PPM by their largest value, TIFF by its tags).
    16-bit files state nothing; both are read with the 8, 10, 12, 14 or 16 bits into which the values of
    both fit, and a note says so. `bits` decides instead. Where the two files' depths differ, both get the
    larger. A gray file beside one of colours becomes RGB.

    An alpha channel is dropped, CMYK becomes RGB, and of several pages the first is used, with a note for
    each. An orientation tag is ignored: turning one view would undo the rectification.

    Raises
    ------
    InputError : a file that cannot be read, values beyond `bits`, or two images of different size.
    """
    if is_standard_input(left) and is_standard_input(right):
        raise InputError(
            "the two images cannot both come from standard input",
            "give one of them as a file, or --side-by-side",
        )
    rasters = [read_raster(left), read_raster(right)]
    require_same_size(rasters[0].values, rasters[1].values, f"'{left}'", f"'{right}'")
    return _pair(rasters, name or _stem(left), bits)


def read_joined(
    path: str | Path, joined: Joined, name: str | None = None, *, bits: int | None = None
) -> StereoPair:
    """Read a pair from one file, as `read_pair` does from two.

    Raises
    ------
    InputError : a file that cannot be read or cut in half, or values beyond `bits`.
    """
    raster = read_raster(path)
    axis = 1 if joined == "side-by-side" else 0
    if raster.values.shape[axis] % 2:
        what = "columns" if axis else "rows"
        raise InputError(
            f"'{path}' is {size_text(raster.values)}: {raster.values.shape[axis]} {what} cannot be halved",
            "give both views at the same size, without anything between them",
        )
    halves = np.split(raster.values, 2, axis=axis)
    first, second = (replace(raster, values=half) for half in halves)
    return _pair([first, replace(second, notes=())], name or _stem(path), bits)


def bring_in(rasters: Sequence[Raster], bits: int | None) -> tuple[list[np.ndarray], tuple[str, ...], int]:
    """Images of one depth, the notes about what was changed, and that depth in bits."""
    notes: list[str] = []
    plain: list[Raster] = []
    for raster in rasters:
        if raster.values.dtype not in (np.uint8, np.uint16):
            raise InputError(
                f"'{raster.path}' holds {raster.values.dtype} values", "convert it to 8 or 16 bits a channel"
            )
        notes += raster.notes
        if raster.values.shape[2] == 4:
            notes.append(f"{raster.name} has an alpha channel: it is dropped")
        plain.append(replace(raster, values=raster.values[:, :, : min(raster.values.shape[2], 3)]))
    whites, found = _whites(plain, bits, notes)
    images = []
    for raster, white in zip(plain, whites, strict=True):
        if white != 2**found - 1:
            notes.append(f"{raster.name} has values 0 to {white}: they are scaled to {found} bits")
        values = rescale(raster.values, white, found)
        images.append(np.ascontiguousarray(values[:, :, 0] if values.shape[2] == 1 else values))
    return images, tuple(dict.fromkeys(notes)), found


def _pair(rasters: Sequence[Raster], name: str, bits: int | None) -> StereoPair:
    (left, right), notes, found = bring_in(rasters, bits)
    if left.ndim != right.ndim:
        which = rasters[0 if left.ndim == 2 else 1].name
        notes += (f"{which} is gray: its values are used for all three channels",)
        left, right = (triple(image) if image.ndim == 2 else image for image in (left, right))
    low, high = (int(extreme) for extreme in (min(left.min(), right.min()), max(left.max(), right.max())))
    white = 2**found - 1
    if high - low < _LEAST_RANGE * white:
        notes += (
            f"the pair uses the values {low} to {high} of 0 to {white}, less than a quarter of the range:"
            f" say --bits N where the files hold fewer bits than {found}",
        )
    if np.array_equal(left, right):
        notes += ("left and right are the same picture: every disparity is 0",)
    return StereoPair(left, right, name, notes=notes, bits=found)


def _whites(rasters: Sequence[Raster], bits: int | None, notes: list[str]) -> tuple[list[int], int]:
    """The value of white in each file, and the bits that all of them get."""
    largest = [int(raster.values.max(initial=0)) for raster in rasters]
    if bits is not None:
        if not 1 <= bits <= MAX_BITS:
            raise InputError(f"--bits {bits} is not a number of bits", f"use 1 to {MAX_BITS}")
        for raster, value in zip(rasters, largest, strict=True):
            if value >= 2**bits:
                raise InputError(
                    f"'{raster.path}' holds {value}, more than --bits {bits} allows",
                    f"use --bits {value.bit_length()} or more",
                )
        return [2**bits - 1] * len(rasters), max(8, bits)
    silent = [raster.white is None for raster in rasters]
    fits = 0
    if any(silent):
        value = max(value for value, unknown in zip(largest, silent, strict=True) if unknown)
        fits = next(depth for depth in _DEPTHS if value < 2**depth)
        if fits < MAX_BITS:
            names = " and ".join(
                dict.fromkeys(r.name for r, unknown in zip(rasters, silent, strict=True) if unknown)
            )
            notes.append(
                f"{names}: 16 bits a channel, but no value above {value}, so read as {fits} bits;"
                " --bits N decides otherwise"
            )
    whites = [2**fits - 1 if raster.white is None else raster.white for raster in rasters]
    return whites, max(8, *(white.bit_length() for white in whites))


def _stem(path: str | Path) -> str:
    return "stdin" if is_standard_input(path) else Path(path).stem
