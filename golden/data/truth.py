"""Ground truth: reading it, and finding which of its pixels the other view sees too."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from softdepth.golden.data.images import read_bytes, read_raw, size_text
from softdepth.spec.errors import InputError

Kind = Literal["auto", "pfm", "gray8", "kitti16"]
View = Literal["left", "right"]
Evidence = Literal["none", "cross-check", "warp", "scene"]

GRAY_PER_PIXEL = 4
"""Gray levels per pixel of disparity in the paper's maps, and in Middlebury's quarter-size truth."""

_SCALES: dict[str, float] = {"pfm": 1, "gray8": GRAY_PER_PIXEL, "kitti16": 256}
_TOLERANCE = 1.0
_PFM_HEADER = re.compile(
    rb"P(?P<channels>[fF])\s+(?P<columns>[1-9]\d{0,5})\s+(?P<rows>[1-9]\d{0,5})\s+(?P<order>-)?[\d.eE+-]+\s"
)


@dataclass(frozen=True, eq=False)
class Truth:
    """The ground truth of one view.

    Parameters
    ----------
    disparity : float32 H x W, in pixels; NaN where unknown.
    gray : float32 H x W, the gray levels that the paper's RMSE (eq. 1) compares with; 0 where unknown
        (``docs/datasets.md`` names the one exception). The file's own values where it codes disparity
        in gray, else ``4 * disparity``, neither rounded nor clipped.
    nonoccluded : bool H x W, the pixels of known disparity that both views see, or None.
    evidence : what `nonoccluded` rests on: both views' truths (``cross-check``), this view's alone
        (``warp``), or the construction of a synthetic scene (``scene``).
    """

    disparity: np.ndarray
    gray: np.ndarray
    nonoccluded: np.ndarray | None = None
    evidence: Evidence = "none"

    @property
    def known(self) -> np.ndarray:
        """bool H x W: the disparity is known."""
        return np.isfinite(self.disparity)


def read_truth(
    path: str | Path,
    *,
    kind: Kind = "auto",
    scale: float | None = None,
    shape: tuple[int, int] | None = None,
    view: View = "left",
) -> Truth:
    """Read the ground truth of `view`; its occluded pixels are found by `visible`.

    Parameters
    ----------
    kind : the coding. ``pfm``: floats, where infinite, NaN and values <= 0 are unknown. ``gray8``:
        8-bit gray, 0 unknown. ``kitti16``: 16-bit gray, 0 unknown. ``auto`` tells them by content.
    scale : file units per pixel of disparity; by default 1, 4 (Middlebury at quarter size) and 256.
    shape : the images' height and width, if it must fit them.

    Raises
    ------
    InputError : a file that cannot be read or is not of that kind, one with no known pixel, or a
        size other than `shape`.
    """
    data = read_bytes(path)
    is_pfm = data[:2] in (b"Pf", b"PF")
    values = _read_pfm(data, path) if is_pfm else _one_channel(read_raw(path), path)
    found = "pfm" if is_pfm else {"uint8": "gray8", "uint16": "kitti16"}.get(str(values.dtype))
    if found is None:
        raise InputError(f"'{path}' holds {values.dtype} values", "give a PFM, or 8-bit or 16-bit gray")
    if kind not in ("auto", found):
        raise InputError(f"truth '{path}' is {found}, not {kind}", f"use kind '{found}' or 'auto'")
    scale = _SCALES[found] if scale is None else scale
    if not (np.isfinite(scale) and scale > 0):
        raise InputError(
            f"truth scale {scale} is not a positive number", "give file units per pixel, such as 4"
        )
    if shape is not None and values.shape != tuple(shape):
        raise InputError(
            f"truth '{path}' is {size_text(values)}, but the images are {shape[1]}x{shape[0]}",
            "give the ground truth of these images, at their size",
        )
    known = np.isfinite(values) & (values > 0)
    if not known.any():
        raise InputError(f"truth '{path}' holds no known disparity", "check that it is a disparity map")
    disparity = np.where(known, values / scale, np.nan).astype(np.float32)
    gray = values if found == "gray8" else None
    return from_disparity(disparity, gray=gray, view=view)


def from_disparity(
    disparity: np.ndarray,
    *,
    gray: np.ndarray | None = None,
    other: np.ndarray | None = None,
    view: View = "left",
) -> Truth:
    """Build the `Truth` of `view` from its disparities, in pixels; non-finite is unknown.

    `gray` are the levels of a file that has them. With `other`, the other view's disparities, the
    occlusions come from `cross_check`, else from `visible`.
    """
    known = np.isfinite(disparity)
    disparity = np.where(known, disparity, np.nan).astype(np.float32)
    levels = np.where(known, GRAY_PER_PIXEL * disparity, 0) if gray is None else gray
    mask = visible(disparity, view) if other is None else cross_check(disparity, other, view)
    return Truth(disparity, levels.astype(np.float32), mask, "warp" if other is None else "cross-check")


def cross_check(disparity: np.ndarray, other: np.ndarray, view: View = "left") -> np.ndarray:
    """The pixels of `view` that the other view's disparities confirm within 1 px: bool H x W.

    ``|dL(x) - dR(round(x - dL(x)))| <= 1`` for the left view, ``x + dR`` for the right. A pixel whose
    partner is outside the image or unknown is not confirmed.
    """
    if disparity.shape != other.shape:
        raise InputError(
            f"the views' truths are {size_text(disparity)} and {size_text(other)}", "give both at one size"
        )
    column, inside = _partner(disparity, view)
    partner = np.take_along_axis(other, column, axis=1)
    with np.errstate(invalid="ignore"):
        return inside & (np.abs(disparity - partner) <= _TOLERANCE)


def visible(disparity: np.ndarray, view: View = "left") -> np.ndarray:
    """The pixels of `view` that the other view sees, judged by this view's disparities: bool H x W.

    Every pixel is moved to its partner column. It is occluded where another one with a disparity
    larger by more than 1 px lands on the same column, and where it lands outside. One pixel of
    difference is no occlusion: neighbours on a slanted surface share a column.
    """
    column, inside = _partner(disparity, view)
    nearest = np.take_along_axis(warp(disparity, view), column, axis=1)
    with np.errstate(invalid="ignore"):
        return inside & (disparity >= nearest - _TOLERANCE)


def warp(disparity: np.ndarray, view: View = "left") -> np.ndarray:
    """Move the disparities of `view` into the other view: float32 H x W, NaN where none lands.

    Columns are rounded to the nearest; the largest disparity (the nearest surface) wins a column.
    """
    column, inside = _partner(disparity, view)
    rows, columns = np.nonzero(inside)
    moved = np.full(disparity.shape, -np.inf, np.float32)
    np.maximum.at(moved, (rows, column[rows, columns]), disparity[rows, columns])
    return np.where(np.isneginf(moved), np.nan, moved).astype(np.float32)


def _partner(disparity: np.ndarray, view: View) -> tuple[np.ndarray, np.ndarray]:
    """The partner's column (0 where there is none), and where it lies inside the other image."""
    width = disparity.shape[1]
    sign = -1 if view == "left" else 1
    target = np.arange(width) + sign * np.where(np.isfinite(disparity), disparity, np.inf)
    target = np.rint(target)
    inside = (target >= 0) & (target < width)
    return np.where(inside, target, 0).astype(np.intp), inside


def _one_channel(image: np.ndarray, path: str | Path) -> np.ndarray:
    colours = image[:, :, :3]
    if (colours != colours[:, :, :1]).any():
        raise InputError(f"truth '{path}' is a colour picture", "give disparities as gray levels or PFM")
    return colours[:, :, 0]


def _read_pfm(data: bytes, path: str | Path) -> np.ndarray:
    """Decode a one-channel PFM: rows run from the bottom up.

    The header's scale gives the byte order by its sign. Its size is ignored, as in Middlebury's own
    reader: their files carry one that is not meant for the disparities, yet OpenCV applies it.
    """
    header = _PFM_HEADER.match(data)
    if header is None:
        raise InputError(f"'{path}' has a broken PFM header", "write it again, as one-channel PFM")
    if header["channels"] != b"f":
        raise InputError(f"'{path}' is a three-channel PFM", "give one channel, disparity in pixels")
    columns, rows, start = int(header["columns"]), int(header["rows"]), header.end()
    size = 4 * rows * columns
    if len(data) - start < size:
        raise InputError(f"'{path}' is cut short", "copy or download it again")
    values = np.frombuffer(data, "<f4" if header["order"] else ">f4", rows * columns, start)
    return values.reshape(rows, columns)[::-1].astype(np.float32)
