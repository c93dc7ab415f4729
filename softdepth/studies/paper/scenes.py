"""The three scenes as a reading wants them: images, and the truth of both views."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from softdepth.golden.data import datasets
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.truth import Truth, View

Size = tuple[int, int]


@dataclass(frozen=True, eq=False)
class Scene:
    """A pair, the `truths` of its two views, and the `digest` that names its pixels."""

    name: str
    left: np.ndarray
    right: np.ndarray
    truths: Mapping[View, Truth]
    digest: str


@lru_cache(maxsize=8)
def load(name: str, size: Size | None = None) -> Scene:
    """Middlebury's scene `name`, brought to `size` (width, height) where one is given.

    Resizing is bilinear for the images and takes the nearest neighbour of the truth. Disparities
    scale with the width; gray levels, which only the paper's RMSE uses, stay the file's.

    Raises `InputError` if the data set is missing or damaged.
    """
    views: dict[View, StereoPair] = {
        "left": datasets.load(f"middlebury:{name}", "left"),
        "right": datasets.load(f"middlebury:{name}", "right"),
    }
    left, right = views["left"].left, views["left"].right
    digest = f"{datasets.pixel_sum(left)}{datasets.pixel_sum(right)}{size}"
    truths: dict[View, Truth] = {}
    for view, pair in views.items():
        assert pair.truth is not None
        truths[view] = pair.truth if size is None else _resized_truth(pair.truth, size)
    if size is not None:
        left, right = (cv2.resize(image, size, interpolation=cv2.INTER_LINEAR) for image in (left, right))
    return Scene(name, left, right, truths, digest)


def _resized_truth(truth: Truth, size: Size) -> Truth:
    def nearest(array: np.ndarray) -> np.ndarray:
        return cv2.resize(array, size, interpolation=cv2.INTER_NEAREST)

    scale = size[0] / truth.disparity.shape[1]
    seen = truth.nonoccluded
    return Truth(
        nearest(truth.disparity) * np.float32(scale),
        nearest(truth.gray),
        None if seen is None else nearest(seen.astype(np.uint8)).astype(bool),
        truth.evidence,
    )
