"""Writing disparity maps and pictures: complete, or not at all."""

from pathlib import Path

import cv2
import numpy as np

from softdepth.files import write_atomically
from softdepth.spec.errors import InputError

KITTI_SCALE = 256
"""Units per pixel of disparity in a 16-bit PNG, as KITTI codes them."""


def write_pfm(path: str | Path, disparity: np.ndarray, valid: np.ndarray | None = None) -> None:
    """Write a map of disparities in pixels as one-channel PFM; no result is infinite, as in Middlebury's.

    A disparity of 0 is kept, and `read_truth` reads it as one; some other readers take it for unknown.

    Raises
    ------
    InputError : a map that is not H x W, or a place that cannot be written.
    """
    values = np.where(_valid(disparity, valid), disparity, np.inf)
    height, width = values.shape
    header = f"Pf\n{width} {height}\n-1.0\n".encode()
    write_atomically(path, header + values[::-1].astype("<f4").tobytes())


def write_disparity_png(
    path: str | Path, disparity: np.ndarray, valid: np.ndarray | None = None, *, first: int = 0
) -> None:
    """Write a map of disparities in pixels as 16-bit PNG in KITTI's coding: ``256 * d``, 0 = no result.

    The coding has no negative numbers: where the first candidate is negative, ``256 * (d - first)`` is
    written, which whoever reads it has to know. A PFM holds the disparities as they are.

    A valid disparity of 0 is written as 1 (1/256 px), as KITTI's own tools do, so that it stays
    distinguishable from no result.

    Raises
    ------
    InputError : a map that is not H x W, disparities outside ``0 .. 255.996``, or a place that
        cannot be written.
    """
    valid = _valid(disparity, valid)
    values = np.rint(np.where(valid, disparity - min(first, 0), 0) * float(KITTI_SCALE))
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


def _valid(disparity: np.ndarray, valid: np.ndarray | None) -> np.ndarray:
    if disparity.ndim != 2:
        raise InputError(f"the disparity map has shape {disparity.shape}", "give height x width")
    finite = np.isfinite(disparity)
    if valid is None:
        return finite
    if valid.shape != disparity.shape:
        raise InputError(
            f"the valid mask has shape {valid.shape}, the map {disparity.shape}", "give both at the same size"
        )
    return finite & valid.astype(bool)


def _png(image: np.ndarray) -> bytes:
    return cv2.imencode(".png", np.ascontiguousarray(image))[1].tobytes()
