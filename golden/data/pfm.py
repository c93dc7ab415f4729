"""Portable float maps, as data sets and cameras' tools really write them."""

import re
from math import isfinite
from pathlib import Path

import numpy as np

from softdepth.golden.data.decode import MAX_SIDE
from softdepth.spec.errors import InputError

START = (b"Pf", b"PF")
"""What the file begins with: one channel, or three."""

_HEADER = re.compile(
    rb"P(?P<channels>[fF])\s+(?P<columns>\S{1,20})\s+(?P<rows>\S{1,20})\s+(?P<scale>\S{1,40})"
)
_NUMBER = re.compile(rb"\+?\d+")
_BYTES = 4


def read_pfm(data: bytes, path: str | Path) -> np.ndarray:
    """Decode a one-channel PFM, whose rows run from the bottom up: float32 H x W, first row on top.

    The numbers of the header may be followed by blanks, and its lines end in LF, CR or CRLF. The scale's
    sign gives the byte order (negative: little-endian). Its size is ignored, as in Middlebury's own reader:
    their files carry one that is not meant for the disparities.

    Raises
    ------
    InputError : a header that makes no sense, three channels, or data that does not fit the header.
    """
    remedy = "write it again, as one-channel PFM"
    header = _HEADER.match(data)
    if header is None:
        raise InputError(f"'{path}' has a broken PFM header", remedy)
    columns, rows = (_side(header[side], path) for side in ("columns", "rows"))
    scale = _scale(header["scale"])
    if scale is None:
        shown = header["scale"].decode("ascii", "replace")
        raise InputError(
            f"'{path}' has a broken PFM header: its scale is {shown!r}",
            "write it again with -1 (little-endian) or 1 (big-endian)",
        )
    if header["channels"] == b"F":
        raise InputError(f"'{path}' is a three-channel PFM", "give one channel, disparity in pixels")
    size = _BYTES * rows * columns
    start = _data_start(data, header.end(), size)
    if start is None:
        raise InputError(f"'{path}' has a broken PFM header", remedy)
    found = len(data) - start
    if found < size:
        raise InputError(f"'{path}' is cut short", "copy or download it again")
    if data[start + size :].strip():
        raise InputError(
            f"'{path}' holds {found} bytes after its header, but {columns}x{rows} values take {size}", remedy
        )
    values = np.frombuffer(data, "<f4" if scale < 0 else ">f4", rows * columns, start)
    return values.reshape(rows, columns)[::-1].astype(np.float32)


def _side(text: bytes, path: str | Path) -> int:
    if not _NUMBER.fullmatch(text) or not int(text):
        shown = text.decode("ascii", "replace")
        raise InputError(
            f"'{path}' has a broken PFM header: a side of {shown!r}", "write it again, as one-channel PFM"
        )
    if int(text) > MAX_SIDE:
        raise InputError(
            f"'{path}' has a side of {int(text)}", f"scale it to at most {MAX_SIDE} pixels a side"
        )
    return int(text)


def _scale(text: bytes) -> float | None:
    """The scale, or None where it is no number or has no sign that could tell the byte order."""
    try:
        scale = float(text)
    except ValueError:
        return None
    return scale if isfinite(scale) and scale != 0 else None


def _data_start(data: bytes, end: int, size: int) -> int | None:
    """Where the values begin behind the scale, which ends at `end`; None where no white space follows.

    The end of the header's last line is ambiguous, because the first value may begin with bytes that look
    like blanks or a line feed: the reading that leaves exactly the values is taken.
    """
    blanks = end
    while data[blanks : blanks + 1] in (b" ", b"\t") and blanks - end < 80:
        blanks += 1
    candidates = [
        place + len(line_end)
        for place in range(blanks, end - 1, -1)
        for line_end in (b"\r\n", b"\n", b"\r", b" ", b"\t")
        if data.startswith(line_end, place)
    ]
    exact = [start for start in candidates if len(data) - start == size]
    return next(iter([*exact, *candidates]), None)
