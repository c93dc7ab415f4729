"""A frame in metres: depth, how much it can be trusted, and its points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softdepth.rig.geometry import Floats, Geometry
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

Bytes = NDArray[np.uint8]


@dataclass(frozen=True)
class Choice:
    """Which results become depth.

    Members
    -------
    measured_only : leave out what was filled in.
    min_confidence : leave out what has less, 0 to 255. Filled results have no confidence of their own, so
        that any floor above 0 leaves them out too.
    """

    measured_only: bool = False
    min_confidence: int = 0

    def __post_init__(self) -> None:
        if not 0 <= self.min_confidence <= 255:
            raise InputError(f"min_confidence is {self.min_confidence}", "use 0 to 255")

    def of(self, code: Bytes, confidence: Bytes | None) -> NDArray[np.bool_]:
        """Where a result counts; raises `InputError` for a floor where there is no confidence."""
        chosen = code < Validity.BORDER
        if not self.measured_only:
            chosen |= code == Validity.FILLED
        if self.min_confidence:
            if confidence is None:
                raise InputError(
                    f"min_confidence is {self.min_confidence}, but the results have no confidence",
                    "use a preset that has it, such as robust, or leave the floor out",
                )
            chosen &= confidence >= self.min_confidence
        return chosen


@dataclass(frozen=True, eq=False)
class Scene:
    """A frame's depth in the left camera's optical frame.

    Members
    -------
    geometry : the rectified pair's.
    depth : H x W float32 in metres, NaN where there is none.
    filled : H x W, where the depth was filled in rather than measured.
    image : the left view, H x W x 3 uint8 RGB, or None.
    """

    geometry: Geometry
    depth: Floats
    filled: NDArray[np.bool_]
    image: Bytes | None = None

    @classmethod
    def of(
        cls,
        geometry: Geometry,
        disparity: NDArray[np.floating],
        code: Bytes,
        confidence: Bytes | None = None,
        *,
        choice: Choice | None = None,
        image: Bytes | None = None,
    ) -> "Scene":
        """The scene of a disparity map in pixels; errors as of `Choice.of`."""
        chosen = (choice or Choice()).of(code, confidence)
        depth = geometry.depth(disparity, chosen)
        return cls(geometry, depth, (code == Validity.FILLED) & np.isfinite(depth), image)

    def points(self) -> tuple[Floats, Bytes | None, NDArray[np.bool_]]:
        """The N points with a depth: N x 3 in metres, their N x 3 colours if known, and which were filled."""
        known = np.isfinite(self.depth)
        colours = None if self.image is None else self.image[known]
        return self.geometry.points(self.depth)[known], colours, self.filled[known]
