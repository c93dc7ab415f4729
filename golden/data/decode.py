"""Image files decoded without conversion: the values a camera or a data set wrote, and the value of
white."""

import io
import logging
import os
import re
import struct
import sys
import tempfile
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import netpbmfile
import numpy as np
from PIL import Image

from softdepth.golden.data.inputs import read_bytes, title
from softdepth.spec.errors import InputError

MAX_SIDE = 8192
"""The longest side of an image, in pixels: the largest frame that a core can be built for."""

FORMATS = "PNG, PPM, PGM, JPEG or TIFF"

_PNG_START = b"\x89PNG\r\n\x1a\n"
_PNG_END = b"IEND\xaeB`\x82"
_NETPBM = re.compile(rb"P[1-7]\s")
_BINARY_NETPBM = re.compile(
    rb"P[56]\s+(?:#[^\n]*\n\s*)*(\d+)\s+(?:#[^\n]*\n\s*)*(\d+)\s+(?:#[^\n]*\n\s*)*(\d+)\r\n"
)
_GRAY_MODES = ("1", "L", "LA", "La", "I", "F", "I;16", "I;16B", "I;16L")
_TIFF_STARTS = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_JPEG_DAMAGE = re.compile(r"Corrupt JPEG data: ([^\n]+)")
_STDERR = 2
_quiet_lock = threading.Lock()


@dataclass(frozen=True, eq=False)
class Raster:
    """A decoded image file.

    Parameters
    ----------
    path : the file, as errors quote it.
    values : H x W x C as in the file, C = 1 (gray), 3 (RGB) or 4 (RGB and alpha).
    white : the value of white, where the file states it; None where it only says how wide its samples are.
    notes : what was left out or converted, one sentence each.
    """

    path: str
    values: np.ndarray
    white: int | None
    notes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """What notes call the file."""
        return title(self.path)


@dataclass(frozen=True)
class _Header:
    """What Pillow knows about a file without decoding it; the defaults if it cannot read it."""

    kind: str = ""
    mode: str = ""
    pages: int = 1
    size: tuple[int, int] = (0, 0)
    bits: int | None = None
    white: int | None = None


def read_raster(path: str | Path) -> Raster:
    """Decode the file `path`, or standard input for ``-``; see `decode` for the errors."""
    return decode(read_bytes(path), path)


def decode(data: bytes, path: str | Path) -> Raster:
    """Decode an image file's bytes; of several pages or frames the first. `path` is what errors quote.

    Raises
    ------
    InputError : data that is cut short, no image, or too large.
    """
    if data.startswith(_PNG_START):
        if _PNG_END not in data:
            raise InputError(f"'{path}' is cut short", "copy or download it again")
        _check_size(*struct.unpack(">II", data[16:24]), path)
    if _NETPBM.match(data):
        return _netpbm(data, path)
    header = _probe(data, path)
    _check_size(*header.size, path)
    notes = []
    if header.pages > 1:
        what = "pages" if header.kind in ("TIFF", "MPO") else "frames"
        notes.append(f"{title(path)} holds {header.pages} {what}: the first is used")
    if header.mode == "CMYK":
        notes.append(f"{title(path)} is CMYK: it is converted to RGB")
        values = _with_pillow(data, path)
    else:
        values, said = _with_opencv(data, path)
        if damage := _JPEG_DAMAGE.search(said):
            notes.append(f"{title(path)} may be damaged: {damage[1]}")
    _check_size(values.shape[1], values.shape[0], path)
    if header.mode in _GRAY_MODES and values.shape[2] == 4:
        # Gray with alpha: OpenCV has no such kind, and makes it a colour picture.
        notes.append(f"{title(path)} has an alpha channel: it is dropped")
        values = values[:, :, :1]
    white = 255 if values.dtype == np.uint8 else header.white
    if values.dtype == np.uint16 and header.bits in (10, 12, 14):
        # Packed samples, which OpenCV moves to the top of its 16 bits.
        values, white = values >> (16 - header.bits), 2**header.bits - 1
    return Raster(str(path), values, white, tuple(notes))


def _probe(data: bytes, path: str | Path) -> _Header:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            if data.startswith(_TIFF_STARTS):
                return _probe_tiff(data)
            image = Image.open(io.BytesIO(data))
            return _Header(image.format or "", image.mode, getattr(image, "n_frames", 1), image.size)
        except Image.DecompressionBombError as error:
            raise _too_large(f"'{path}' is too large", path) from error
        except Exception:  # a library for damaged files of any kind: what is wrong is told by the decoder
            return _Header()


def _probe_tiff(data: bytes) -> _Header:
    """The same of a TIFF, with its bits a sample and its white: Pillow does not know all kinds."""
    import tifffile  # where a file is one: it takes longer to load than most images do

    logging.getLogger("tifffile").disabled = True  # what it has to say about damaged tags
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page = file.pages.first
        white = page.tags.get("MaxSampleValue")
        value = white.value[0] if white and isinstance(white.value, tuple) else white and white.value
        mode = "CMYK" if page.photometric == tifffile.PHOTOMETRIC.SEPARATED else ""
        size = (page.imagewidth, page.imagelength)
        return _Header("TIFF", mode, len(file.pages), size, page.bitspersample, _white(value))


def _white(value: int | None) -> int | None:
    """A TIFF's largest sample value, where it can be white: some writers put the picture's own there."""
    return value if value is not None and 255 <= value < 65535 and value & (value + 1) == 0 else None


def _with_opencv(data: bytes, path: str | Path) -> tuple[np.ndarray, str]:
    """The pixels, and what the libraries said meanwhile."""
    try:
        # From memory, because `cv2.imread` fills up some cut files in silence; `imdecode` refuses them.
        with quiet() as said:
            image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise _unreadable(path) from error
    if image is None:
        raise _unreadable(path)
    if image.ndim == 2:
        return image[:, :, np.newaxis], said.getvalue()
    return image[:, :, [2, 1, 0, 3][: image.shape[2]]], said.getvalue()


def _with_pillow(data: bytes, path: str | Path) -> np.ndarray:
    with warnings.catch_warnings(), quiet():
        warnings.simplefilter("ignore")
        try:
            return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))
        except Exception as error:  # as in `_probe`
            raise _unreadable(path) from error


def _netpbm(data: bytes, path: str | Path) -> Raster:
    """PBM, PGM, PPM and PAM: OpenCV scales some of them by their largest value, and some not."""
    try:
        with netpbmfile.NetpbmFile(io.BytesIO(_without_carriage_return(data))) as file:
            width, height, depth, white = file.width, file.height, file.depth, file.maxval
            bitmap = file.magicnumber in ("P1", "P4")
            _check_size(width, height, path)
            values = np.asarray(file.asarray())
    except InputError:
        raise
    except Exception as error:  # whatever the library makes of a damaged file
        raise _unreadable(path) from error
    size = width * height * depth
    if not size or not 1 <= white <= 0xFFFF or values.size % size:
        raise _unreadable(path)
    notes = []
    if values.size > size:
        notes.append(f"{title(path)} goes on after its first picture: only that is used")
    values = values.reshape(-1)[:size].reshape(height, width, depth)
    values = (~values if bitmap else values).astype(np.uint8 if white <= 0xFF else np.uint16)
    if values.max() > white:
        raise InputError(f"'{path}' holds {values.max()}, but its header says {white}", "write it again")
    if depth == 2:
        notes.append(f"{title(path)} has an alpha channel: it is dropped")
        values = values[:, :, :1]
    return Raster(str(path), values, None if white == 0xFFFF else white, tuple(notes))


def _without_carriage_return(data: bytes) -> bytes:
    """A binary PGM or PPM whose header lines end in CRLF, ended as the format has it."""
    header = _BINARY_NETPBM.match(data)
    if header is None:
        return data
    width, height, white = (int(number) for number in header.groups())
    samples = width * height * (3 if data.startswith(b"P6") else 1)
    if len(data) - header.end() != samples * (2 if white > 0xFF else 1):
        return data  # the line feed is the first sample
    return data[: header.end() - 2] + data[header.end() - 1 :]


def _check_size(width: int, height: int, path: str | Path) -> None:
    if max(width, height) > MAX_SIDE:
        raise _too_large(f"'{path}' is {width}x{height}", path)


def _too_large(problem: str, path: str | Path) -> InputError:
    return InputError(problem, f"scale it to at most {MAX_SIDE} pixels a side")


def _unreadable(path: str | Path) -> InputError:
    return InputError(f"'{path}' cannot be decoded", f"give an undamaged {FORMATS} image")


@contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Keep the messages of OpenCV, libpng, libjpeg and libtiff off the terminal, and collect them in the
    result.

    The libraries write to the process's standard error directly, so it is redirected while they decode.
    """
    said = io.StringIO()
    with _quiet_lock, tempfile.TemporaryFile() as aside:
        if sys.stderr is not None:
            sys.stderr.flush()
        try:
            kept = os.dup(_STDERR)
        except OSError:  # there is none
            yield said
            return
        try:
            os.dup2(aside.fileno(), _STDERR)
            yield said
        finally:
            os.dup2(kept, _STDERR)
            os.close(kept)
            aside.seek(0)
            said.write(aside.read().decode("utf-8", "replace"))
