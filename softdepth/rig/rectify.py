"""Rectifying raw pairs: maps from rectified pixels to raw ones, and how many lines they need to buffer."""

from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.rig.camera import Camera
from softdepth.rig.geometry import Geometry
from softdepth.rig.rig import Rectification, Rig
from softdepth.spec.errors import InputError


@dataclass(frozen=True, eq=False)
class Rectifier:
    """The maps of a rig for images of one size.

    Members
    -------
    maps : for the left and the right view, H x W x 2 float32: column and row of the raw image that a
        rectified pixel takes its value from.
    rectification : what they follow.
    """

    maps: tuple[np.ndarray, np.ndarray]
    rectification: Rectification

    @classmethod
    def of(cls, rig: Rig, size: tuple[int, int]) -> "Rectifier":
        """The rectifier of images of `size` (width, height).

        Raises `InputError` for images of another size than the calibration's, for a rig without a baseline,
        and for cameras above each other.
        """
        for side, camera in (("left", rig.left), ("right", rig.right)):
            if camera.size is not None and camera.size != size:
                raise InputError(
                    f"the images are {size[0]}x{size[1]}, the {side} camera is calibrated for"
                    f" {camera.size[0]}x{camera.size[1]}",
                    "give images of that size, or the calibration of these",
                )
        found = rig.rectification or _computed(rig, size)
        maps = (
            _map(camera, rotation, projection, size)
            for camera, rotation, projection in zip(
                (rig.left, rig.right), found.rotations, found.projections, strict=True
            )
        )
        return cls((next(maps), next(maps)), found)

    @property
    def geometry(self) -> Geometry:
        """The rectified pair's."""
        return self.rectification.geometry

    def apply(self, left: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rectify two raw images, H x W or H x W x C, uint8 or uint16; what no camera saw is 0."""
        views = [
            cv2.remap(
                view,
                field[..., 0],
                field[..., 1],
                cv2.INTER_LINEAR,
                borderMode=cv2.BORDER_CONSTANT,
                borderValue=0,
            )
            for view, field in zip((left, right), self.maps, strict=True)
        ]
        return views[0], views[1]

    def row_budget(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """For each view, how many rows the map reaches up and down from the row that is being made.

        A rectifier on the chip keeps that many lines: both, and the one in hand. Rectified pixels that lie
        outside the raw image ask for none.
        """
        budgets = []
        for field in self.maps:
            height, width = field.shape[:2]
            column, row = field[..., 0], field[..., 1]
            inside = (column > -1) & (column < width) & (row > -1) & (row < height)
            reach = row - np.arange(height, dtype=np.float32)[:, None]
            up = int(np.ceil(-reach[inside].min(initial=0)))
            down = int(np.ceil(reach[inside].max(initial=0)))
            budgets.append((max(0, up), max(0, down)))
        return budgets[0], budgets[1]


def _computed(rig: Rig, size: tuple[int, int]) -> Rectification:
    """OpenCV's rectification, with both principal points in one place and no pixel without a value."""
    if rig.baseline <= 0:
        raise InputError("the two cameras are in the same place", "check the calibration's translation")
    if rig.left.lens != rig.right.lens:
        raise InputError(
            f"the left lens is {rig.left.lens}, the right one {rig.right.lens}",
            "calibrate both with the same model",
        )
    if rig.left.lens == "equidistant":
        r1, r2, p1, p2, _ = cv2.fisheye.stereoRectify(
            rig.left.matrix,
            rig.left.distortion.reshape(4, 1),
            rig.right.matrix,
            rig.right.distortion.reshape(4, 1),
            size,
            rig.rotation,
            rig.translation.reshape(3, 1),
            cv2.CALIB_ZERO_DISPARITY,
        )
    else:
        r1, r2, p1, p2, *_ = cv2.stereoRectify(
            rig.left.matrix,
            rig.left.distortion,
            rig.right.matrix,
            rig.right.distortion,
            size,
            rig.rotation,
            rig.translation.reshape(3, 1),
            flags=cv2.CALIB_ZERO_DISPARITY,
            alpha=0,
        )
    if abs(p2[1, 3]) > abs(p2[0, 3]):
        raise InputError(
            "the cameras stand above each other", "turn both images by 90 degrees and recalibrate"
        )
    r1, r2, p1, p2 = (np.asarray(matrix, np.float64) for matrix in (r1, r2, p1, p2))
    return Rectification((r1, r2), (p1, p2))


def _map(camera: Camera, rotation: np.ndarray, projection: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    if camera.lens == "equidistant":
        columns, rows = cv2.fisheye.initUndistortRectifyMap(
            camera.matrix, camera.distortion.reshape(4, 1), rotation, projection[:, :3], size, cv2.CV_32FC1
        )
    else:
        columns, rows = cv2.initUndistortRectifyMap(
            camera.matrix, camera.distortion, rotation, projection[:, :3], size, cv2.CV_32FC1
        )
    return np.dstack([columns, rows])
