"""What a rectified pair is written as: its images, its calibration, and a picture to look at."""

from pathlib import Path

import cv2
import numpy as np

from softdepth.files import write_atomically
from softdepth.golden.data.writers import write_picture
from softdepth.rig.rectify import Rectifier

FILES = ("left.png", "right.png", "calibration.yml", "epipolar.png")
"""The names in the folder; ``calibration.yml`` is moved in last."""
LINES = 16
"""Epipolar lines in the picture."""


def write(folder: Path, rectifier: Rectifier, left: np.ndarray, right: np.ndarray) -> None:
    """Write a rectified pair (uint8 RGB) and what belongs to it into a folder."""
    write_picture(folder / "left.png", left)
    write_picture(folder / "right.png", right)
    write_picture(folder / "epipolar.png", epipolar(left, right))
    write_atomically(
        folder / "calibration.yml", calibration(rectifier, left.shape[1], left.shape[0]).encode()
    )


def calibration(rectifier: Rectifier, width: int, height: int, comment: str = "") -> str:
    """The rectified pair's calibration as OpenCV's YAML, lengths in metres: R1, R2, P1, P2 and Q.

    The rotations are identities, because these cameras are already those of the rectified images.
    A comment stands before them.
    """
    storage = cv2.FileStorage(".yml", cv2.FILE_STORAGE_WRITE | cv2.FILE_STORAGE_MEMORY)
    if comment:
        storage.writeComment(comment)
    storage.write("image_width", width)
    storage.write("image_height", height)
    for key, rotation in (("R1", np.eye(3)), ("R2", np.eye(3))):
        storage.write(key, rotation)
    for key, projection in zip(("P1", "P2"), rectifier.rectification.projections, strict=True):
        storage.write(key, projection)
    geometry = rectifier.geometry
    storage.write(
        "Q",
        np.array(
            [
                [1, 0, 0, -geometry.cx],
                [0, 1, 0, -geometry.cy],
                [0, 0, 0, geometry.focal],
                [0, 0, 1 / geometry.baseline, geometry.doffs / geometry.baseline],
            ]
        ),
    )
    return storage.releaseAndGetString()


def epipolar(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Both views side by side, with lines on which a point of one lies in the other."""
    picture = np.hstack([left, right])
    colours = np.array([(255, 80, 80), (80, 255, 80), (90, 160, 255), (255, 220, 60)], np.uint8)
    for number, row in enumerate(np.linspace(0, len(picture) - 1, LINES + 2).astype(int)[1:-1]):
        picture[row] = colours[number % len(colours)]
    return picture
