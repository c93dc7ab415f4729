"""The result of a frame: a disparity and its validity code for every pixel."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity


class Result(NamedTuple):
    """One pixel's result: disparity in the map's units, its `Validity` code as a plain number, confidence."""

    disparity: int
    code: int
    confidence: int | None = None

    def __str__(self) -> str:
        known = self.code in Validity.__members__.values()
        code = Validity(self.code).name if known else f"code {self.code}"
        sure = "" if self.confidence is None else f", confidence {self.confidence}"
        return f"{self.disparity} ({code}{sure})"


class Difference(NamedTuple):
    """A pixel in which two maps disagree."""

    y: int
    x: int
    expected: Result
    got: Result

    def __str__(self) -> str:
        return f"y={self.y} x={self.x}: expected {self.expected}, got {self.got}"


def has_value(code: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Whether a pixel with this code has a disparity: it was measured or filled."""
    return (code < Validity.BORDER) | (code == Validity.FILLED)


@dataclass(frozen=True, eq=False)
class DisparityMap:
    """Disparities of a frame and why each is, or is not, a measurement.

    Members
    -------
    disparity : HxW uint16, or int16 where candidates are negative, in units of ``2**-fraction_bits``
        pixels; 0 where there is none.
    code : HxW uint8, a `Validity` each.
    fraction_bits : `Post.fraction_bits`.
    confidence : HxW uint8, 255 the surest and 0 where nothing was measured; None where a core gives none.

    Raises `InputError` unless all are two-dimensional, of these types and of one shape.
    """

    disparity: NDArray[np.integer[Any]]
    code: NDArray[np.uint8]
    fraction_bits: int = 0
    confidence: NDArray[np.uint8] | None = None

    def __post_init__(self) -> None:
        arrays: list[tuple[str, NDArray[Any], type]] = [
            ("disparity", self.disparity, np.int16 if self.disparity.dtype == np.int16 else np.uint16),
            ("code", self.code, np.uint8),
        ]
        if self.confidence is not None:
            arrays.append(("confidence", self.confidence, np.uint8))
        for name, array, dtype in arrays:
            if array.ndim != 2 or array.dtype != dtype:
                raise InputError(
                    f"{name} is {array.dtype} of shape {array.shape}",
                    f"give a two-dimensional {np.dtype(dtype)} array",
                )
            if self.disparity.shape != array.shape:
                raise InputError(
                    f"disparity has shape {self.disparity.shape}, {name} has shape {array.shape}",
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

    @property
    def given(self) -> NDArray[np.bool_]:
        """HxW: where there is a disparity, measured or filled."""
        return has_value(self.code)

    @property
    def pixels(self) -> NDArray[np.float32]:
        """HxW: the disparities in pixels."""
        return self.disparity.astype(np.float32) / np.float32(1 << self.fraction_bits)

    def mirrored(self) -> Self:
        """The map with every row reversed."""
        sure = None if self.confidence is None else self.confidence[:, ::-1]
        return type(self)(self.disparity[:, ::-1], self.code[:, ::-1], self.fraction_bits, sure)

    def differences(self, got: Self) -> Iterator[Difference]:
        """Pixels in which `got` departs from this, the expected map; raster order.

        Raises `InputError` if the shapes or units differ, or if only one has confidences.
        """
        if self.shape != got.shape:
            raise InputError(
                f"expected a {self.shape} map, got {got.shape}", "compare maps of the same frame"
            )
        mine, other = (
            (found.fraction_bits, "no" if found.confidence is None else "a") for found in (self, got)
        )
        if mine != other:
            raise InputError(
                f"expected {mine[0]} fraction bits and {mine[1]} confidence, got {other[0]} and {other[1]}",
                "compare maps of the same configuration",
            )
        return self._differences(got)

    def _differences(self, got: Self) -> Iterator[Difference]:
        differs = (self.disparity != got.disparity) | (self.code != got.code)
        if self.confidence is not None and got.confidence is not None:
            differs |= self.confidence != got.confidence
        for y, x in np.argwhere(differs).tolist():
            yield Difference(y, x, self.at(x, y), got.at(x, y))

    def at(self, x: int, y: int) -> Result:
        """The result of one pixel."""
        sure = None if self.confidence is None else int(self.confidence[y, x])
        return Result(int(self.disparity[y, x]), int(self.code[y, x]), sure)
