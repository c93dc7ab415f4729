"""Writing disparity maps and pictures: complete, or not at all."""

import os
from pathlib import Path

import cv2
import numpy as np

from softdepth.errors import InputError

KITTI_SCALE = 256
"""Units per pixel of disparity in a 16-bit PNG, as KITTI codes them."""


def write_pfm(path: str | Path, disparity: np.ndarray, valid: np.ndarray | None = None) -> None:
    """Write a map of disparities in pixels as one-channel PFM; no result is infinite, as in Middlebury's.

    A disparity of 0 is kept; note that most readers, `read_truth` among them, take it for unknown.

    Raises
    ------
    InputError : a map that is not H x W, or a place that cannot be written.
    """
    values = np.where(_valid(disparity, valid), disparity, np.inf)
    height, width = values.shape
    header = f"Pf\n{width} {height}\n-1.0\n".encode()
    write_atomically(path, header + values[::-1].astype("<f4").tobytes())


def write_disparity_png(path: str | Path, disparity: np.ndarray, valid: np.ndarray | None = None) -> None:
    """Write a map of disparities in pixels as 16-bit PNG in KITTI's coding: ``256 * d``, 0 = no result.

    A valid disparity of 0 is written as 1 (1/256 px), as KITTI's own tools do, so that it stays
    distinguishable from no result.

    Raises
    ------
    InputError : a map that is not H x W, disparities outside ``0 .. 255.996``, or a place that
        cannot be written.
    """
    valid = _valid(disparity, valid)
    values = np.rint(np.where(valid, disparity, 0) * float(KITTI_SCALE))
    for worst in (values.min(), values.max()):
        if not 0 <= worst <= 0xFFFF:
            raise InputError(
                f"disparity {worst / KITTI_SCALE:g} does not fit a 16-bit PNG", "write a PFM instead"
            )
    values = np.where(valid, np.maximum(values, 1), 0)
    write_atomically(path, _png(values.astype(np.uint16)))


def write_picture(path: str | Path, picture: np.ndarray) -> None:
    """Write a uint8 RGB picture, H x W x 3, as PNG.

    Raises
    ------
    InputError : a picture that is not uint8 H x W x 3, or a place that cannot be written.
    """
    if picture.dtype != np.uint8 or picture.ndim != 3 or picture.shape[2] != 3:
        raise InputError(
            f"the picture is {picture.dtype} of shape {picture.shape}", "give 8-bit RGB, height x width x 3"
        )
    write_atomically(path, _png(picture[:, :, ::-1]))


def write_atomically(path: str | Path, data: bytes) -> None:
    """Write a file under a temporary name beside its place, then rename it: nobody sees half of it.

    Raises
    ------
    InputError : a folder that is missing or is none, a path that is a folder, no right to write, or
        a full disk. The file that was there before is left as it was.
    """
    path = Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    remedy = "give a path in a folder that you may write"
    try:
        if path.is_dir():
            raise InputError(f"'{path}' is a folder", "name a file in it")
        try:
            part.write_bytes(data)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except FileNotFoundError as error:
        raise InputError(f"folder '{path.parent}' does not exist", "create it first") from error
    except NotADirectoryError as error:
        raise InputError(f"cannot write '{path}': part of the path is a file", remedy) from error
    except OSError as error:
        raise InputError(f"cannot write '{path}': {error.strerror or error}", remedy) from error


def _valid(disparity: np.ndarray, valid: np.ndarray | None) -> np.ndarray:
    if disparity.ndim != 2:
        raise InputError(f"the disparity map has shape {disparity.shape}", "give height x width")
    finite = np.isfinite(disparity)
    if valid is None:
        return finite
    if valid.shape != disparity.shape:
        raise InputError(
            f"the valid mask has shape {valid.shape}, the map {disparity.shape}", "give both at one size"
        )
    return finite & valid.astype(bool)


def _png(image: np.ndarray) -> bytes:
    return cv2.imencode(".png", np.ascontiguousarray(image))[1].tobytes()
