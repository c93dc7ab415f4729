"""The model of two cameras that every calibration is read into, and what it amounts to once rectified."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from softdepth.rig.camera import Camera, Matrix
from softdepth.rig.geometry import Geometry
from softdepth.spec.errors import InputError


@dataclass(frozen=True, eq=False)
class Rectification:
    """How the rays of both cameras are turned, and how they are projected after that.

    Members
    -------
    rotations : two 3 x 3, from each camera's frame to its rectified one.
    projections : two 3 x 4 in pixels; the last column of the right one holds ``-f B``, in pixel metres.
    """

    rotations: tuple[Matrix, Matrix]
    projections: tuple[Matrix, Matrix]

    @property
    def geometry(self) -> Geometry:
        """What turns disparities into metres; raises `InputError` for projections that give none."""
        left, right = self.projections
        focal = float(right[0, 0])
        if focal <= 0:
            raise InputError(f"the right projection's focal length is {focal:g}", "give pixels above 0")
        baseline = float(left[0, 3] / left[0, 0] - right[0, 3] / focal)
        if baseline < 0:
            raise InputError(
                f"the right camera lies {-baseline:g} m left of the left one", "exchange the two calibrations"
            )
        cx, cy = float(left[0, 2]), float(left[1, 2])
        return Geometry(focal, baseline, float(right[0, 2]) - cx, cx, cy)

    @property
    def between(self) -> tuple[Matrix, Matrix]:
        """How the cameras are placed to each other: a `Rig`'s rotation and translation."""
        left, right = self.rotations
        return right.T @ left, right.T @ np.array([-self.geometry.baseline, 0.0, 0.0])


@dataclass(frozen=True, eq=False)
class Rig:
    """Two cameras, and how they are placed to each other.

    Members
    -------
    left, right : the cameras as they are.
    rotation, translation : 3 x 3, and 3 in metres: a point ``x`` of the left camera's frame is
        ``rotation @ x + translation`` in the right one's, as in OpenCV.
    rectification : the calibration's own, or None.
    rectified : the images are rectified already; nothing is left to do.
    """

    left: Camera
    right: Camera
    rotation: Matrix
    translation: Matrix
    rectification: Rectification | None = None
    rectified: bool = False

    @classmethod
    def of_rectified(cls, left: Matrix, right: Matrix, size: tuple[int, int] | None) -> Self:
        """The rig of rectified images, from their two 3 x 4 projections (pixels, pixel metres)."""
        straight = Rectification((np.eye(3), np.eye(3)), (left, right))
        cameras = (Camera(p[:, :3], np.zeros(5), size=size) for p in (left, right))
        return cls(
            *cameras,
            rotation=np.eye(3),
            translation=np.array([-straight.geometry.baseline, 0.0, 0.0]),
            rectification=straight,
            rectified=True,
        )

    @property
    def baseline(self) -> float:
        """Distance of the cameras in metres."""
        return float(np.linalg.norm(self.translation))
