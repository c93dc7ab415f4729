"""One camera as it is, before rectification."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import InputError

Matrix = NDArray[np.float64]
Lens = Literal["radtan", "equidistant"]
"""``radtan``: OpenCV's polynomial (k1 k2 p1 p2 [k3 ...]); ``equidistant``: its fisheye model (k1 .. k4)."""

_COEFFICIENTS = {"radtan": (4, 5, 8, 12, 14), "equidistant": (4,)}


@dataclass(frozen=True, eq=False)
class Camera:
    """Intrinsics and distortion.

    Members
    -------
    matrix : 3 x 3, focal lengths and principal point in pixels.
    distortion : coefficients in OpenCV's order, of 4 to 14 as the `lens` has them.
    lens : the model that they belong to.
    size : (width, height) in pixels, or None where the calibration leaves it out.

    Raises `InputError` for a matrix that no camera has, and for coefficients that the lens cannot have.
    """

    matrix: Matrix
    distortion: Matrix
    lens: Lens = "radtan"
    size: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        good = self.matrix.shape == (3, 3) and np.isfinite(self.matrix).all()
        if not good or min(self.matrix[0, 0], self.matrix[1, 1]) <= 0:
            raise InputError(
                f"a camera matrix is {np.array2string(self.matrix, precision=1).replace(chr(10), '')}",
                "give 3 x 3 numbers with focal lengths in pixels above 0",
            )
        if self.distortion.size not in _COEFFICIENTS[self.lens] or not np.isfinite(self.distortion).all():
            allowed = ", ".join(map(str, _COEFFICIENTS[self.lens]))
            raise InputError(
                f"{self.distortion.size} coefficients of distortion", f"a {self.lens} lens has {allowed}"
            )
