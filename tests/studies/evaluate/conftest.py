"""Small scenes on disk."""

from pathlib import Path

import cv2
import numpy as np

from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.writers import write_pfm


def write_scene(folder: Path, *, middlebury: bool = False, width: int = 72, height: int = 40) -> Path:
    """A generated pair with its truth: left.png, right.png and truth.pfm, or with Middlebury's names."""
    folder.mkdir(parents=True)
    pair = generate("steps", width=width, height=height, disparities=16)
    assert pair.truth is not None
    names = ("im2.png", "im6.png") if middlebury else ("left.png", "right.png")
    for name, image in zip(names, (pair.left, pair.right), strict=True):
        cv2.imwrite(str(folder / name), image[:, :, ::-1])
    if not middlebury:
        write_pfm(folder / "truth.pfm", pair.truth.disparity)
        return folder
    right = generate("steps", width=width, height=height, disparities=16, view="right")
    assert right.truth is not None
    for name, truth in (("disp2.png", pair.truth), ("disp6.png", right.truth)):
        cv2.imwrite(str(folder / name), np.rint(4 * np.nan_to_num(truth.disparity)).astype(np.uint8))
    return folder
