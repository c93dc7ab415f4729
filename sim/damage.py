"""Frames as broken sources send them: lines cut or too long, markers missing or misplaced.

Each function takes the transfers of one frame as `softdepth.sim.transfers.pack_frame` gives them
of pixels of `rgb8` and returns a damaged copy. Rows and columns count from 0.
"""

import numpy as np

from softdepth.hdl.signatures import pair_layout
from softdepth.sim.transfers import Payloads, unpack_field
from softdepth.spec.errors import InputError
from softdepth.spec.pixel import PixelFormat

PAIR = pair_layout(PixelFormat.RGB8)


def drop_pixels(transfers: Payloads, y: int, count: int) -> Payloads:
    """Line `y` lacks `count` pixels; its last pixel and markers stay."""
    start, end = _line(transfers, y)
    if not 0 < count < end - start:
        raise InputError(f"cannot drop {count} of a line's {end - start} pixels", "leave at least one")
    return np.delete(transfers, np.s_[end - 1 - count : end - 1])


def add_pixels(transfers: Payloads, y: int, count: int) -> Payloads:
    """Line `y` has `count` more pixels, unmarked, before its last."""
    start, end = _line(transfers, y)
    markers = _bit("sof") | _bit("eol") | _bit("eof")
    extra = np.resize(transfers[start:end] & ~markers, count)
    return np.insert(transfers, end - 1, extra)


def drop_start(transfers: Payloads) -> Payloads:
    """The frame has no start of frame."""
    return transfers & ~_bit("sof")


def drop_line_end(transfers: Payloads, y: int) -> Payloads:
    """Line `y` has no end of line: it runs on into the next."""
    _, end = _line(transfers, y)
    damaged = transfers.copy()
    damaged[end - 1] &= ~_bit("eol")
    return damaged


def truncate(transfers: Payloads, y: int, x: int = 0) -> Payloads:
    """The frame stops before pixel (x, y): what follows is an early start of the next frame."""
    return transfers[: _line(transfers, y)[0] + x].copy()


def add_start(transfers: Payloads, y: int, x: int) -> Payloads:
    """Pixel (x, y) claims to start a frame."""
    damaged = transfers.copy()
    damaged[_line(transfers, y)[0] + x] |= _bit("sof")
    return damaged


def _line(transfers: Payloads, y: int) -> tuple[int, int]:
    """First transfer of line `y`, and the first after it."""
    ends = np.flatnonzero(unpack_field(PAIR, "eol", transfers)) + 1
    if not 0 <= y < len(ends):
        raise InputError(f"line {y} is not in a frame of {len(ends)} lines", f"use 0 to {len(ends) - 1}")
    return (int(ends[y - 1]) if y else 0), int(ends[y])


def _bit(marker: str) -> np.uint64:
    return np.uint64(1 << PAIR[marker].offset)
