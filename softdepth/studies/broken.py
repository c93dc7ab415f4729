"""Sound pairs broken in known ways, to see whether `softdepth inspect` names what was done."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.inspect.findings import Code

ROWS = 16
"""Rows of offset, up and down, that are tried."""
DEGREES = (-1.0, -0.5, 0.5, 1.0)
DARKER = 0.7
GAMMA = 1.5
PALE = 0.02
"""Contrast that is left of a pair with nothing to match."""


@dataclass(frozen=True, eq=False)
class Broken:
    """A pair that is wrong in one way.

    Members
    -------
    kind : what was done, as a row of a table says it.
    left, right : uint8 RGB images.
    code : the finding that names it.
    offset : the rows by which the right view was moved down, or None.
    halved : the pair is sound, and its range is to be halved.
    """

    kind: str
    left: np.ndarray
    right: np.ndarray
    code: Code
    offset: int | None = None
    halved: bool = False


def variants(
    left: np.ndarray, right: np.ndarray, other: np.ndarray, rows: tuple[int, ...] | None = None
) -> Iterator[Broken]:
    """Every variant of a sound pair of uint8 RGB images.

    `other` is a view of another scene. `rows` are the offsets to try; all from 1 to `ROWS` by default.
    """
    yield Broken("left and right exchanged", right, left, "exchanged")
    for count in rows or range(1, ROWS + 1):
        kind = "right view 1 row off" if count == 1 else f"right view 2 .. {ROWS} rows off"
        yield Broken(kind, left[:-count], right[count:], "rows", offset=-count)
        yield Broken(kind, left[count:], right[:-count], "rows", offset=count)
    for degrees in DEGREES:
        kind = f"right view turned by +-{abs(degrees):g} degrees"
        yield Broken(kind, left, turned(right, degrees), "unrectified")
    yield Broken(f"right view darkened to {DARKER:g}", left, scaled(right, DARKER), "brightness")
    for gamma in (GAMMA, 1 / GAMMA):
        yield Broken(
            f"right view with gamma {GAMMA:g} or 1/{GAMMA:g}", left, curved(right, gamma), "brightness"
        )
    yield Broken(f"contrast of both {PALE:g}", pale(left), pale(right), "bare")
    height, width = (min(sides) for sides in zip(left.shape[:2], other.shape[:2], strict=True))
    yield Broken("right view of another scene", left[:height, :width], other[:height, :width], "unmatched")
    yield Broken("half of the candidates needed", left, right, "short", halved=True)


def turned(view: np.ndarray, degrees: float) -> np.ndarray:
    """A view turned about its middle, as sharp as it was."""
    height, width = view.shape[:2]
    matrix = cv2.getRotationMatrix2D(((width - 1) / 2, (height - 1) / 2), degrees, 1)
    return cv2.warpAffine(
        view, matrix, (width, height), flags=cv2.INTER_LANCZOS4, borderMode=cv2.BORDER_REPLICATE
    )


def scaled(view: np.ndarray, factor: float) -> np.ndarray:
    """A view with its brightness multiplied."""
    return np.rint(view * factor).clip(0, 255).astype(np.uint8)


def curved(view: np.ndarray, gamma: float) -> np.ndarray:
    """A view with another gamma: ``255 * (v / 255) ** gamma``."""
    return np.rint(255 * (np.arange(256) / 255) ** gamma).astype(np.uint8)[view]


def pale(view: np.ndarray) -> np.ndarray:
    """A view with next to no contrast."""
    return scaled(128 + (view.astype(float) - 128) * PALE, 1)
