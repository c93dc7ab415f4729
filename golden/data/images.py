"""Reading rectified stereo pairs from image files."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np

from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.truth import Truth

MAX_SIDE = 8192
"""The longest side of an image, in pixels: the largest frame that a core can be built for."""

FORMATS = "PNG, PPM, PGM, JPEG or TIFF"

_PNG_START = b"\x89PNG\r\n\x1a\n"
_PNG_END = b"IEND\xaeB`\x82"


@dataclass(frozen=True, eq=False)
class StereoPair:
    """A rectified stereo pair, and what is known about it.

    Parameters
    ----------
    left, right : uint8 RGB, H x W x 3, of one size.
    name : what reports call the pair.
    truth : the ground truth of the reference view, if known.
    notes : what was changed on the way in, one sentence each, worth showing to a user.

    Raises
    ------
    InputError : an array that is not uint8 H x W x 3, or two of different size.
    """

    left: np.ndarray
    right: np.ndarray
    name: str
    truth: "Truth | None" = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for side, image in (("left", self.left), ("right", self.right)):
            if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3:
                raise InputError(
                    f"the {side} image is {image.dtype} of shape {image.shape}",
                    "give 8-bit RGB, height x width x 3",
                )
        _same_size(self.left, self.right, "the left image", "the right image")

    @property
    def height(self) -> int:
        """Rows."""
        return self.left.shape[0]

    @property
    def width(self) -> int:
        """Columns."""
        return self.left.shape[1]


def read_pair(left: str | Path, right: str | Path, name: str | None = None) -> StereoPair:
    """Read two image files as a pair called `name` (default: the left file's stem).

    Raises
    ------
    InputError : a file that `read_image` refuses, or two images of different size.
    """
    left_image, left_notes = read_image(left)
    right_image, right_notes = read_image(right)
    _same_size(left_image, right_image, f"'{left}'", f"'{right}'")
    notes = (*left_notes, *right_notes)
    if np.array_equal(left_image, right_image):
        notes += ("left and right are the same picture: every disparity is 0",)
    return StereoPair(left_image, right_image, name or Path(left).stem, notes=notes)


def read_image(path: str | Path) -> tuple[np.ndarray, tuple[str, ...]]:
    """Read an image file as uint8 RGB, H x W x 3, with a note for each conversion.

    Gray values go to all three channels, 16-bit values ``v`` become ``round(v / 257)``, and an alpha
    channel is dropped. An orientation tag is ignored: turning one view would undo the rectification.

    Raises
    ------
    InputError : a file that is missing, a folder, cut short, no image, too large, or not of integers.
    """
    name = Path(path).name
    image = read_raw(path)
    notes: list[str] = []
    if image.dtype == np.uint16:
        image = np.rint(image / 257).astype(np.uint8)
        notes.append(f"{name} has 16 bits a channel: its values are scaled to 8 bits")
    if image.dtype != np.uint8:
        raise InputError(f"'{path}' holds {image.dtype} values", "convert it to 8 or 16 bits a channel")
    if image.shape[2] == 4:
        image = image[:, :, :3]
        notes.append(f"{name} has an alpha channel: it is dropped")
    if image.shape[2] == 1:
        image = np.repeat(image, 3, axis=2)
        notes.append(f"{name} is gray: its values are used for all three channels")
    return np.ascontiguousarray(image), tuple(notes)


def read_raw(path: str | Path) -> np.ndarray:
    """Decode an image file without conversion: H x W x C, C = 1 (gray), 3 (RGB) or 4 (RGBA).

    Raises
    ------
    InputError : a file that is missing, a folder, cut short, no image, or too large.
    """
    data = read_bytes(path)
    if data.startswith(_PNG_START):
        if _PNG_END not in data:
            raise InputError(f"'{path}' is cut short", "copy or download it again")
        _check_size(*struct.unpack(">II", data[16:24]), path)
    unreadable = InputError(f"'{path}' cannot be decoded", f"give an undamaged {FORMATS} image")
    try:
        # From memory, because `cv2.imread` fills up some cut files in silence; `imdecode` refuses them.
        with _quiet():
            image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise unreadable from error
    if image is None:
        raise unreadable
    _check_size(image.shape[1], image.shape[0], path)
    if image.ndim == 2:
        return image[:, :, np.newaxis]
    return image[:, :, [2, 1, 0, 3][: image.shape[2]]]


def read_bytes(path: str | Path) -> bytes:
    """The contents of a file; raises `InputError` where there are none."""
    path = Path(path)
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"'{path}' does not exist", "check the path") from error
    except IsADirectoryError as error:
        raise InputError(f"'{path}' is a folder", "name a file in it") from error
    except OSError as error:
        raise InputError(
            f"'{path}' cannot be read: {error.strerror}", "check the path and its rights"
        ) from error
    if not data:
        raise InputError(f"'{path}' is empty", "copy or download it again")
    return data


def size_text(array: np.ndarray) -> str:
    """``width x height`` of an image, as users write it: ``450x375``."""
    return f"{array.shape[1]}x{array.shape[0]}"


def _same_size(left: np.ndarray, right: np.ndarray, left_name: str, right_name: str) -> None:
    if left.shape[:2] != right.shape[:2]:
        raise InputError(
            f"{left_name} is {size_text(left)}, but {right_name} is {size_text(right)}",
            "give two rectified images of one size",
        )


def _check_size(width: int, height: int, path: str | Path) -> None:
    if max(width, height) > MAX_SIDE:
        raise InputError(f"'{path}' is {width}x{height}", f"scale it to at most {MAX_SIDE} pixels a side")


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep OpenCV's own log lines off the terminal: the one-line error says it all."""
    # OpenCV 5 moved these two functions; 4 has them at the top level.
    log = cv2 if hasattr(cv2, "setLogLevel") else cv2.utils.logging
    level = log.getLogLevel()  # pyright: ignore[reportAttributeAccessIssue]
    log.setLogLevel(0)  # pyright: ignore[reportAttributeAccessIssue]
    try:
        yield
    finally:
        log.setLogLevel(level)  # pyright: ignore[reportAttributeAccessIssue]
