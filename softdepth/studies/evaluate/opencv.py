"""OpenCV's matchers, brought to what ours give: a disparity in every pixel.

They leave a band on the left without results, as wide as the number of candidates. Padding both views on the
left by that many pixels avoids it. Pixels that they then leave invalid are filled like those in our own
results; `with_post` gives their results to our filters instead.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.pair import Image
from softdepth.golden.post.fill import fill
from softdepth.golden.post.island import on_an_island
from softdepth.golden.post.masked_median import both
from softdepth.golden.post.median import median
from softdepth.golden.post.sixteenths import UNITS
from softdepth.spec.post import Post

BLOCK, SGBM_BLOCK = 15, 3
TITLES = {"bm15": "OpenCV BM15", "sgbm": "OpenCV SGBM", "hh": "OpenCV SGBM HH"}

Raw = NDArray[np.int16]
"""Disparities in sixteenths of a pixel; negative where there is none."""


def match(name: str, left: Image, right: Image, candidates: int) -> Raw:
    """What the matcher `name` of `TITLES` finds in a pair of uint8 RGB images."""
    multiple = -(-candidates // 16) * 16  # they take multiples alone
    views = (
        cv2.copyMakeBorder(np.ascontiguousarray(view), 0, 0, multiple, 0, cv2.BORDER_REPLICATE)
        for view in (left, right)
    )
    if name == "bm15":
        gray = (cv2.cvtColor(view, cv2.COLOR_RGB2GRAY) for view in views)
        found = cv2.StereoBM.create(multiple, BLOCK).compute(*gray)
    else:
        channels = 3
        mode = cv2.STEREO_SGBM_MODE_HH if name == "hh" else cv2.STEREO_SGBM_MODE_SGBM
        found = cv2.StereoSGBM.create(
            minDisparity=0,
            numDisparities=multiple,
            blockSize=SGBM_BLOCK,
            P1=8 * channels * SGBM_BLOCK**2,
            P2=32 * channels * SGBM_BLOCK**2,
            disp12MaxDiff=1,
            uniquenessRatio=10,
            speckleWindowSize=100,
            speckleRange=2,
            mode=mode,
        ).compute(*views)
    return found[:, multiple:].astype(np.int16)


def filled(raw: Raw) -> NDArray[np.float32]:
    """In pixels, filled from the smaller neighbour in the row."""
    values = fill(np.maximum(raw, 0).astype(np.uint16), raw >= 0)
    return values.astype(np.float32) / np.float32(UNITS)


def with_post(raw: Raw, image: Image, post: Post) -> NDArray[np.float32]:
    """In pixels, after our island test, filling and medians; `image` is the left view."""
    valid = raw >= 0
    values = np.maximum(raw, 0).astype(np.uint16)
    valid &= ~on_an_island(valid, post.island, post.island_rows, post.island_columns)
    values, everywhere = fill(values, valid), np.ones(raw.shape, bool)
    if post.median:
        values = median(values, everywhere)
    if post.masked_median:
        *_, (_, values) = both(values, everywhere, image, post)
    return values.astype(np.float32) / np.float32(UNITS)
