"""The result of a frame: a disparity and its validity code for every pixel."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity


class Result(NamedTuple):
    """One pixel's result: disparity in pixels, and its `Validity` code as a plain number."""

    disparity: int
    code: int

    def __str__(self) -> str:
        known = self.code in Validity.__members__.values()
        return f"{self.disparity} ({Validity(self.code).name if known else f'code {self.code}'})"


class Difference(NamedTuple):
    """A pixel in which two maps disagree."""

    y: int
    x: int
    expected: Result
    got: Result

    def __str__(self) -> str:
        return f"y={self.y} x={self.x}: expected {self.expected}, got {self.got}"


@dataclass(frozen=True, eq=False)
class DisparityMap:
    """Disparities of a frame and why each is, or is not, a measurement.

    Members
    -------
    disparity : HxW uint16, in pixels; 0 where there is no measurement.
    code : HxW uint8, a `Validity` each.

    Raises `InputError` unless both are two-dimensional, of these types and of one shape.
    """

    disparity: NDArray[np.uint16]
    code: NDArray[np.uint8]

    def __post_init__(self) -> None:
        for name, array, dtype in (("disparity", self.disparity, np.uint16), ("code", self.code, np.uint8)):
            if array.ndim != 2 or array.dtype != dtype:
                raise InputError(
                    f"{name} is {array.dtype} of shape {array.shape}",
                    f"give a two-dimensional {np.dtype(dtype)} array",
                )
        if self.disparity.shape != self.code.shape:
            raise InputError(
                f"disparity has shape {self.disparity.shape}, code has shape {self.code.shape}",
                "give both for the same pixels",
            )

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width in pixels."""
        height, width = self.disparity.shape
        return height, width

    @property
    def valid(self) -> NDArray[np.bool_]:
        """HxW: where the disparity is a measurement."""
        return self.code < Validity.BORDER

    def mirrored(self) -> Self:
        """The map with every row reversed."""
        return type(self)(self.disparity[:, ::-1], self.code[:, ::-1])

    def differences(self, got: Self) -> Iterator[Difference]:
        """Pixels in which `got` departs from this, the expected map; raster order.

        Raises `InputError` when the shapes differ.
        """
        if self.shape != got.shape:
            raise InputError(f"expected a {self.shape} map, got {got.shape}", "compare maps of one frame")
        return self._differences(got)

    def _differences(self, got: Self) -> Iterator[Difference]:
        for y, x in np.argwhere((self.disparity != got.disparity) | (self.code != got.code)).tolist():
            yield Difference(y, x, self.at(x, y), got.at(x, y))

    def at(self, x: int, y: int) -> Result:
        """The result of one pixel."""
        return Result(int(self.disparity[y, x]), int(self.code[y, x]))
