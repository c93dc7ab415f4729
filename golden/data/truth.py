"""Ground truth: reading it, and finding which of its pixels the other view sees too."""

import io
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from softdepth.golden.data import pfm
from softdepth.golden.data.decode import Raster, decode
from softdepth.golden.data.inputs import read_bytes, size_text
from softdepth.spec.errors import InputError

Kind = Literal["auto", "pfm", "npy", "float", "gray8", "kitti16"]
View = Literal["left", "right"]
Evidence = Literal["none", "cross-check", "warp", "scene"]

GRAY_PER_PIXEL = 4
"""Gray levels per pixel of disparity in the paper's maps, and in Middlebury's quarter-size truth."""

_SCALES: dict[str, float] = {"pfm": 1, "npy": 1, "float": 1, "gray8": GRAY_PER_PIXEL, "kitti16": 256}
_ZERO_IS_UNKNOWN = ("gray8", "kitti16")
_NPY_START = b"\x93NUMPY"
_TOLERANCE = 1.0
# A share of zeros worth a word; disparities in pixels that are too small, and that no narrow image forbids.
_MANY, _LEAST, _POSSIBLE = 0.01, 1e-6, 256


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
    notes : what a user should know about how the file was read, one sentence each.
    """

    disparity: np.ndarray
    gray: np.ndarray
    nonoccluded: np.ndarray | None = None
    evidence: Evidence = "none"
    notes: tuple[str, ...] = ()

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
    candidates: int | None = None,
) -> Truth:
    """Read the ground truth of `view`; its occluded pixels are found by `visible`.

    Parameters
    ----------
    kind : the coding. Floats, of which all finite ones are disparities, 0 and negative ones too: ``pfm``,
        ``npy`` (NumPy's, whole numbers as well) and ``float`` (TIFF). Gray, where 0 is unknown: ``gray8``
        of 8 and ``kitti16`` of 16 bits. ``auto`` tells them by content.
    scale : file units per pixel of disparity; by default 1 for floats, 4 (Middlebury at quarter size)
        and 256.
    shape : the images' height and width, if it must fit them.
    candidates : how many disparities will be scored with it. With them, a gray file whose levels are too
        small for the default scale is an error that asks for `scale`.

    Raises
    ------
    InputError : a file that cannot be read or is not of that kind, one with no known pixel, a
        size other than `shape`, or levels that fit no scene at this scale.
    """
    values, found, notes = _read_values(path)
    if kind not in ("auto", found):
        raise InputError(f"truth '{path}' is {found}, not {kind}", f"use kind '{found}' or 'auto'")
    if scale is not None and not (np.isfinite(scale) and scale > 0):
        raise InputError(
            f"truth scale {scale} is not a positive number", "give file units per pixel, such as 4"
        )
    if shape is not None and values.shape != tuple(shape):
        raise InputError(
            f"truth '{path}' is {size_text(values)}, but the images are {shape[1]}x{shape[0]}",
            "give the ground truth of these images, at their size",
        )
    known = np.isfinite(values) & ((values > 0) | (found not in _ZERO_IS_UNKNOWN))
    if not known.any():
        raise InputError(f"truth '{path}' holds no known disparity", "check that it is a disparity map")
    if scale is None and found in _ZERO_IS_UNKNOWN and candidates is not None:
        _ask_for_scale(values[known], found, path, candidates)
    with np.errstate(all="ignore"):
        disparity = np.where(known, values / (_SCALES[found] if scale is None else scale), np.nan)
        disparity = disparity.astype(np.float32)
    _require_sense(disparity, path)
    zeros = np.mean(disparity == 0)
    if zeros > _MANY:
        share = f"{100 * zeros:.1f} % of the truth"
        notes += (f"{share} is 0, which is a disparity in floats; unknown is inf or NaN there",)
    gray = values if found == "gray8" else None
    return replace(from_disparity(disparity, gray=gray, view=view), notes=notes)


def _read_values(path: str | Path) -> tuple[np.ndarray, str, tuple[str, ...]]:
    """A truth file's values as they are, H x W, what they are coded in, and notes."""
    data = read_bytes(path)
    if data[:2] in pfm.START:
        return pfm.read_pfm(data, path), "pfm", ()
    if data.startswith(_NPY_START):
        return _read_npy(data, path), "npy", ()
    raster = decode(data, path)
    values = _one_channel(raster, path)
    kinds = {"uint8": "gray8", "uint16": "kitti16", "float32": "float", "float64": "float"}
    found = kinds.get(str(values.dtype))
    if found is None:
        raise InputError(
            f"'{path}' holds {values.dtype} values", "give PFM, NPY, TIFF of floats, or 8-bit or 16-bit gray"
        )
    return values, found, raster.notes


def _read_npy(data: bytes, path: str | Path) -> np.ndarray:
    """An array of NumPy's own file format, which may hold no objects: those are programs."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            values = np.load(io.BytesIO(data), allow_pickle=False)
    except Exception as error:  # NumPy raises what its header's parser raises
        raise InputError(
            f"'{path}' is not a readable NPY file", "save it again, as an array of floats"
        ) from error
    if values.dtype.kind not in "fiu":
        raise InputError(f"'{path}' holds {values.dtype} values", "save disparities as an array of floats")
    squeezed = values.squeeze() if values.ndim > 2 else values
    if squeezed.ndim != 2 or not squeezed.size:
        raise InputError(f"'{path}' has the shape {values.shape}", "give height x width disparities")
    return squeezed.astype(np.float64)


def _ask_for_scale(levels: np.ndarray, found: str, path: str | Path, candidates: int) -> None:
    """Raise `InputError` if gray levels are so small that the default scale is hardly theirs."""
    scale, largest = int(_SCALES[found]), int(levels.max())
    whole = not (levels % scale).any()
    if whole or largest >= max(candidates, scale):
        return
    raise InputError(
        f"truth '{path}' has levels up to {largest}, fewer than the {max(candidates, scale)} it could have:"
        f" {scale} a pixel would make {largest / scale:.2g} px the largest disparity",
        f"give --gt-scale 1 if a level is a pixel, or --gt-scale {scale} if that is right",
    )


def _require_sense(disparity: np.ndarray, path: str | Path) -> None:
    """Raise `InputError` if the disparities are of no size that a pair could have."""
    known = np.abs(disparity[np.isfinite(disparity)])
    nonzero = known[known > 0]
    width = disparity.shape[1]
    largest = max(width, _POSSIBLE)
    if not known.size or np.median(known) > largest or (nonzero.size and nonzero.max() < _LEAST):
        size = float(np.median(nonzero)) if nonzero.size else 0
        raise InputError(
            f"truth '{path}' holds disparities like {size:.2g} px in an image {width} wide",
            "give --gt-scale N, and check the file's byte order",
        )


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
            f"the views' truths are {size_text(disparity)} and {size_text(other)}",
            "give both at the same size",
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


def _one_channel(raster: Raster, path: str | Path) -> np.ndarray:
    colours = raster.values[:, :, :3]
    if not all(np.array_equal(colours[:, :, 0], colours[:, :, c]) for c in range(1, colours.shape[2])):
        raise InputError(f"truth '{path}' is a colour picture", "give disparities as gray levels or PFM")
    return colours[:, :, 0]
