"""Pictures of disparity maps as arrays: in colour, by their codes, and against the truth."""

import io

import cv2
import numpy as np
from PIL import Image

from softdepth.golden.data.truth import Truth
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

Colour = tuple[int, int, int]

_KEPT = np.minimum(np.linspace(0.1, 1, 256) * 256, 255).astype(np.uint8)

COLOUR_MAP = cv2.applyColorMap(_KEPT[:, np.newaxis], cv2.COLORMAP_TURBO)[:, 0, ::-1]
"""The colours of a map, 256 x 3 uint8 RGB of turbo: blue is far, red is near. The dark violet end is left
out, so that far is nowhere near `NO_RESULT`."""

NO_RESULT = (24, 24, 27)
"""The colour of pixels without a result: near black."""

_SHADES: dict[Validity, tuple[float, int]] = {Validity.PARTIAL: (0.55, 255), Validity.FILLED: (0.5, 128)}
"""What a disparity's colour is mixed with, and how much, where it is not a full measurement."""

CODE_COLOURS: dict[Validity, Colour] = {
    Validity.FULL: (0, 114, 178),
    Validity.PARTIAL: (86, 180, 233),
    Validity.BORDER: NO_RESULT,
    Validity.FILLED: (240, 228, 66),
    Validity.INCONSISTENT: (213, 94, 0),
    Validity.ISLAND: (204, 121, 167),
    Validity.NOTHING: (150, 150, 150),
}
"""The palette of `code_picture`: Okabe and Ito's colours, which the colour-blind tell apart too."""

ERROR_COLOURS: dict[str, Colour] = {
    "within 1 px": (222, 235, 227),
    "1 to 2 px": (247, 188, 66),
    "over 2 px": (200, 40, 50),
    "no result": NO_RESULT,
    "truth unknown": (128, 142, 166),
}
"""The legend of `error_picture`."""


def colour_range(disparity: np.ndarray, valid: np.ndarray) -> tuple[float, float]:
    """The smallest and the largest disparity worth a colour of their own: whole pixels, never equal.

    One in two hundred of the valid pixels may lie beyond either end, so that a few wrong ones do not take
    the colours away from the rest.
    """
    shown = disparity[_mask(disparity, valid, "valid mask") & np.isfinite(disparity)]
    if not shown.size:
        return 0.0, 1.0
    low, high = np.percentile(shown, (0.5, 99.5))
    return float(np.floor(low)), float(max(np.ceil(high), np.floor(low) + 1))


def colour(
    disparity: np.ndarray,
    valid: np.ndarray,
    maximum: float,
    *,
    minimum: float = 0,
    code: np.ndarray | None = None,
) -> np.ndarray:
    """A map of disparities (pixels, H x W) in colour: uint8 RGB, H x W x 3.

    `minimum` and less is blue, `maximum` and more dark red; pixels that are not `valid` are `NO_RESULT`.
    With the validity `code` of each pixel (H x W), those of which only part of the range was compared are
    paler, and filled ones grayer. Give maps that are to be compared the same range.

    Raises
    ------
    InputError : an empty range, or a mask of another shape.
    """
    if not maximum > minimum:
        raise InputError(
            f"the maximum disparity is {maximum}, the minimum {minimum}", "give a larger maximum, in pixels"
        )
    valid = _mask(disparity, valid, "valid mask") & np.isfinite(disparity)
    scaled = (np.where(valid, disparity, minimum) - minimum) / (maximum - minimum)
    last = len(COLOUR_MAP) - 1
    picture = COLOUR_MAP[np.minimum(np.clip(scaled, 0, 1) * len(COLOUR_MAP), last).astype(np.uint8)]
    if code is not None:
        for kind in _SHADES:
            picture[code == kind] = shaded(picture[code == kind], kind)
    picture[~valid] = NO_RESULT
    return picture


def code_picture(code: np.ndarray) -> bytes:
    """The validity codes of a frame (H x W) as PNG with a palette: a pixel's value is its code, shown in
    `CODE_COLOURS`."""
    image = Image.fromarray(code.astype(np.uint8), "P")
    palette = np.zeros((max(CODE_COLOURS) + 1, 3), np.uint8)
    for kind, rgb in CODE_COLOURS.items():
        palette[kind] = rgb
    image.putpalette(palette.tobytes())
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()


def shaded(rgb: np.ndarray, kind: Validity) -> np.ndarray:
    """Colours (... x 3 uint8) of disparities as `colour` shows them where they are PARTIAL or FILLED."""
    share, towards = _SHADES[kind]
    return np.rint((1 - share) * rgb + share * towards).astype(np.uint8)


def error_picture(disparity: np.ndarray, truth: Truth, valid: np.ndarray | None = None) -> np.ndarray:
    """Where a map is right and where it is wrong: uint8 RGB, H x W x 3, in `ERROR_COLOURS`.

    The classes are those of bad-1.0 and bad-2.0: up to and including 1 px, up to and including 2 px,
    more. Unknown truth wins over no result, as in the metrics.

    Raises
    ------
    InputError : shapes that differ.
    """
    known = _mask(disparity, truth.known, "truth")
    valid = np.isfinite(disparity) if valid is None else _mask(disparity, valid, "valid mask")
    error = np.abs(np.where(known, disparity - truth.disparity.astype(np.float64), 0))
    picture = np.empty((*disparity.shape, 3), np.uint8)
    picture[:] = ERROR_COLOURS["within 1 px"]
    picture[error > 1] = ERROR_COLOURS["1 to 2 px"]
    picture[error > 2] = ERROR_COLOURS["over 2 px"]
    picture[~valid] = ERROR_COLOURS["no result"]
    picture[~known] = ERROR_COLOURS["truth unknown"]
    return picture


def _mask(disparity: np.ndarray, mask: np.ndarray, what: str) -> np.ndarray:
    if disparity.ndim != 2 or mask.shape != disparity.shape:
        raise InputError(
            f"the disparity map has shape {disparity.shape}, the {what} {mask.shape}",
            "give both at the same size",
        )
    return mask.astype(bool)
