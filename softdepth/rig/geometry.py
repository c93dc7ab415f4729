"""The geometry of a rectified pair: what turns disparities into metres."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import InputError

Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Geometry:
    """A rectified pair of cameras, as the left one sees it (x right, y down, z ahead: ROS' optical frame).

    Members
    -------
    focal : focal length of the rectified images, in pixels.
    baseline : distance of the two cameras, in metres.
    doffs : column of the right view's principal point less the left one's, in pixels: Middlebury's name.
    cx, cy : principal point of the left view, in pixels.
    frame_id : the name of the left camera's optical frame, as ROS has it.

    Raises `InputError` for a focal length or a baseline that is not above zero, or for numbers that are none.
    """

    focal: float
    baseline: float
    doffs: float = 0.0
    cx: float = 0.0
    cy: float = 0.0
    frame_id: str = "left_camera_optical_frame"

    def __post_init__(self) -> None:
        for name, unit in (("focal", "pixels"), ("baseline", "metres")):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InputError(f"{name} is {value:g}", f"give a number of {unit} above 0")
        for name in ("doffs", "cx", "cy"):
            if not math.isfinite(getattr(self, name)):
                raise InputError(f"{name} is {getattr(self, name)}", "give a number of pixels")

    @property
    def scale(self) -> float:
        """Focal length times baseline, in pixel metres: depth is this over ``disparity + doffs``."""
        return self.focal * self.baseline

    def depth(self, disparity: NDArray[np.floating], valid: NDArray[np.bool_]) -> Floats:
        """``Z = f B / (d + doffs)`` in metres; NaN where not valid, or where no finite depth is ahead.

        Parameters
        ----------
        disparity : H x W, in pixels of the left view.
        valid : H x W, which of them count.
        """
        reach = disparity.astype(np.float64) + self.doffs
        ahead = valid & (reach > 0)
        result = np.full(disparity.shape, np.nan, np.float32)
        result[ahead] = self.scale / reach[ahead]
        return result

    def uncertainty(self, depth: Floats, disparity_error: float) -> Floats:
        """The depth's standard error in metres, ``Z^2 / (f B)`` times the disparity's in pixels."""
        return (depth.astype(np.float64) ** 2 / self.scale * disparity_error).astype(np.float32)

    def distance(self, disparity: float) -> float:
        """Depth in metres of one disparity; infinite where nothing finite has it."""
        reach = disparity + self.doffs
        return self.scale / reach if reach > 0 else math.inf

    def points(self, depth: Floats) -> Floats:
        """H x W x 3 coordinates in metres in the left camera's optical frame; NaN where the depth is."""
        height, width = depth.shape
        x = (np.arange(width) - self.cx) / self.focal
        y = (np.arange(height) - self.cy) / self.focal
        return np.stack([depth * x, depth * y[:, None], depth], axis=-1).astype(np.float32)
