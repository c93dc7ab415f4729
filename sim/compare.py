"""Where simulated maps differ from the model's."""

from collections.abc import Sequence
from typing import NamedTuple

from softdepth.golden.maps import DisparityMap, Result
from softdepth.spec.errors import InputError


class Mismatch(NamedTuple):
    """A pixel that differs: frame number from 0, place in the frame, and both results."""

    frame: int
    y: int
    x: int
    expected: Result
    got: Result

    def __str__(self) -> str:
        return f"frame {self.frame} y={self.y} x={self.x}: expected {self.expected}, got {self.got}"


def mismatches(expected: Sequence[DisparityMap], got: Sequence[DisparityMap]) -> list[Mismatch]:
    """Every pixel in which two sequences of maps differ, in disparity or code; in order.

    Raises `InputError` when they differ in number or in a frame's shape.
    """
    if len(expected) != len(got):
        raise InputError(
            f"expected {len(expected)} frames, got {len(got)}", "compare maps of the same frames"
        )
    return [
        Mismatch(number, *difference)
        for number, (wanted, found) in enumerate(zip(expected, got, strict=True))
        for difference in wanted.differences(found)
    ]
