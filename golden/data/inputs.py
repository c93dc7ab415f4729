"""Reading what a user names: the bytes of a file or of standard input."""

import sys
from pathlib import Path

import numpy as np

from softdepth.spec.errors import InputError

STANDARD_INPUT = "-"
"""The file name that means standard input."""


def is_standard_input(path: str | Path | None) -> bool:
    """Whether this name means standard input."""
    return path is not None and str(path) == STANDARD_INPUT


def title(path: str | Path) -> str:
    """What notes call a file: its name without the folders."""
    return "standard input" if is_standard_input(path) else Path(path).name


def read_bytes(path: str | Path) -> bytes:
    """The contents of a file, or of standard input for ``-``; raises `InputError` if there are none."""
    if is_standard_input(path):
        return _read_standard_input()
    path = Path(path)
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"'{path}' does not exist", "check the path") from error
    except IsADirectoryError as error:
        raise InputError(f"'{path}' is a folder", "name a file in it") from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"'{path}' cannot be read: {reason}", "check the path and its rights") from error
    if not data:
        raise InputError(f"'{path}' is empty", "copy or download it again")
    return data


def size_text(array: np.ndarray) -> str:
    """``width x height`` of an image, as users write it: ``450x375``."""
    return f"{array.shape[1]}x{array.shape[0]}"


def _read_standard_input() -> bytes:
    remedy = "pipe a file into it, or name one in place of '-'"
    if sys.stdin is None or sys.stdin.closed:
        raise InputError("standard input is closed", remedy)
    if sys.stdin.isatty():
        raise InputError("standard input is the terminal", remedy)
    try:
        data = sys.stdin.buffer.read()
    except OSError as error:
        raise InputError(f"standard input cannot be read: {error.strerror}", remedy) from error
    if not data:
        raise InputError("standard input is empty", remedy)
    return data
