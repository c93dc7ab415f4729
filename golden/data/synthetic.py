"""Generated stereo scenes whose ground truth is exact."""

from collections.abc import Callable

import cv2
import numpy as np

from softdepth.golden.data.decode import MAX_SIDE
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.truth import GRAY_PER_PIXEL, Truth, View
from softdepth.spec.errors import InputError

MIN_DISPARITIES = 4
MAX_DISPARITIES = 256

# A scene is the left view's disparities 1 .. disparities - 1, and its surfaces' numbers, H x W each.
Scene = tuple[np.ndarray, np.ndarray]


def _plane(height: int, width: int, disparities: int, rng: np.random.Generator) -> Scene:
    """One wall facing the cameras."""
    return np.full((height, width), disparities // 2), np.zeros((height, width), int)


def _steps(height: int, width: int, disparities: int, rng: np.random.Generator) -> Scene:
    """Columns of a staircase that comes nearer towards the right."""
    count = min(6, disparities - 1)
    surface = np.broadcast_to(np.arange(width) * count // width, (height, width))
    return np.rint(np.linspace(1, disparities - 1, count)).astype(int)[surface], surface


def _slanted(height: int, width: int, disparities: int, rng: np.random.Generator) -> Scene:
    """A floor that rises towards the viewer, and a wall on it turned about its upright axis."""
    y, x = np.mgrid[:height, :width]
    near = disparities - 1
    floor = 1 + (0.6 * near - 1) * y / max(1, height - 1)
    wall = (0.4 + 0.6 * x / max(1, width - 1)) * near
    on_wall = (abs(x - 0.55 * width) < 0.22 * width) & (y > 0.15 * height) & (y < 0.75 * height)
    return np.rint(np.where(on_wall, wall, floor)).astype(int), on_wall.astype(int)


def _random(height: int, width: int, disparities: int, rng: np.random.Generator) -> Scene:
    """A far wall behind fronto-parallel rectangles at random places and depths."""
    disparity = np.ones((height, width), int)
    surface = np.zeros((height, width), int)
    for number, depth in enumerate(np.sort(rng.integers(2, disparities, 14)), 1):
        h, w = (rng.integers(side // 8 + 1, side // 3 + 2) for side in (height, width))
        top, left = rng.integers(0, max(1, height - h)), rng.integers(0, max(1, width - w))
        disparity[top : top + h, left : left + w] = depth
        surface[top : top + h, left : left + w] = number
    return disparity, surface


_SCENES: dict[str, Callable[[int, int, int, np.random.Generator], Scene]] = {
    "plane": _plane,
    "steps": _steps,
    "slanted": _slanted,
    "random": _random,
}

SCENES: tuple[str, ...] = tuple(_SCENES)
"""The names that `generate` knows."""


def generate(
    scene: str,
    *,
    width: int = 320,
    height: int = 240,
    disparities: int = 32,
    seed: int = 0,
    view: View = "left",
) -> StereoPair:
    """Make a textured pair with the exact ground truth of `view`.

    Disparities are whole pixels, ``1 .. disparities - 1`` (0 would read as unknown in most files).
    The right image is the left one moved pixel by pixel, the nearest surface winning a column; what
    only the right view sees gets texture of its own, and no truth there. So ``L(x, y)`` equals
    ``R(x - d, y)`` in every channel wherever both views see the point, and `Truth.nonoccluded` is
    exact: where a slanted surface is compressed, its occlusions are single columns.

    Raises
    ------
    InputError : an unknown scene, or a size, range or seed out of bounds.
    """
    if scene not in _SCENES:
        raise InputError(f"unknown synthetic scene '{scene}'", f"use one of {', '.join(SCENES)}")
    _check("width", width, 8, MAX_SIDE)
    _check("height", height, 1, MAX_SIDE)
    _check("disparities", disparities, MIN_DISPARITIES, min(MAX_DISPARITIES, width))
    _check("seed", seed, 0, 2**63 - 1)
    rng = np.random.default_rng(seed)
    disparity, surface = _SCENES[scene](height, width, disparities, rng)
    left = _texture(height, width, surface, rng)
    right = _texture(height, width, np.zeros_like(surface), rng)

    # The z-buffer: sorted from far to near, so that the nearest surface is written last.
    rows, columns = np.divmod(np.argsort(disparity, axis=None, kind="stable"), width)
    target = columns - disparity[rows, columns]
    rows, columns, target = (a[target >= 0] for a in (rows, columns, target))
    source = np.full((height, width), -1)
    source[rows, target] = columns
    seen_rows, seen = np.nonzero(source >= 0)
    origin = source[seen_rows, seen]
    right[seen_rows, seen] = left[seen_rows, origin]

    if view == "left":
        truth, both = disparity.astype(np.float32), np.zeros((height, width), bool)
        both[seen_rows, origin] = True
    else:
        truth, both = np.full((height, width), np.nan, np.float32), source >= 0
        truth[seen_rows, seen] = disparity[seen_rows, origin]
    gray = np.where(np.isfinite(truth), GRAY_PER_PIXEL * truth, 0).astype(np.float32)
    name = f"synthetic:{scene}@{width}x{height}x{disparities}#{seed}"
    return StereoPair(left, right, name, Truth(truth, gray, both, "scene"))


def _texture(height: int, width: int, surface: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Fine grain over coarser blotches, on a base colour for each surface: uint8 RGB."""
    image = rng.uniform(80, 175, (int(surface.max()) + 1, 3))[surface]
    for grain, amplitude in ((1, 22), (3, 22), (12, 30)):
        noise = rng.uniform(-1, 1, (-(-height // grain), -(-width // grain), 3))
        image = image + amplitude * cv2.resize(noise, (width, height), interpolation=cv2.INTER_LINEAR)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def _check(what: str, value: int, low: int, high: int) -> None:
    if not low <= value <= high:
        raise InputError(f"synthetic {what} is {value}", f"use {low} to {high}")
