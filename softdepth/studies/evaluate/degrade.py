"""Pairs degraded in one way, as cameras do it, to see how a method tuned on good pairs copes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from softdepth.golden.data.pair import StereoPair
from softdepth.golden.front.pair import Image

DARK, GAMMA, NOISE = 0.7, 1.3, 5.0
WHITE = 255
SEED = 12

Degrade = Callable[[Image, Image], tuple[Image, Image]]


def _dark(left: Image, right: Image) -> tuple[Image, Image]:
    return left, _bytes(right * DARK)


def _gamma(left: Image, right: Image) -> tuple[Image, Image]:
    return left, _bytes(WHITE * (right / WHITE) ** GAMMA)


def _noise(left: Image, right: Image) -> tuple[Image, Image]:
    random = np.random.default_rng(SEED)
    noisy = [_bytes(view + random.normal(0, NOISE, view.shape)) for view in (left, right)]
    return noisy[0], noisy[1]


def _row(left: Image, right: Image) -> tuple[Image, Image]:
    return left, np.concatenate((right[:1], right[:-1]))


WAYS: dict[str, tuple[str, Degrade]] = {
    "dark": (f"right view at {DARK} of its brightness", _dark),
    "gamma": (f"right view with gamma {GAMMA}", _gamma),
    "noise": (f"noise of {NOISE:g} levels (standard deviation) in both views", _noise),
    "row": ("right view one row too low", _row),
}
"""What each way does, and the function that does it."""


def degraded(pair: StereoPair, way: str) -> StereoPair:
    """The pair, made worse in the way called `way`; its truth stays."""
    left, right = WAYS[way][1](pair.left, pair.right)
    return replace(pair, left=left, right=right)


def _bytes(values: np.ndarray) -> Image:
    return np.clip(np.rint(values), 0, WHITE).astype(np.uint8)
