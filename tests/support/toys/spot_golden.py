"""The criterion `spot`: the difference of the pixel's own first channel. Its statement, and its model."""

from collections.abc import Callable
from typing import Literal

import numpy as np
from pydantic import Field

from softdepth.golden.costs.criteria import EVALUATE
from softdepth.golden.costs.values import Values
from softdepth.golden.front.pair import Image
from softdepth.spec.criteria import CRITERIA, AnyCriterion
from softdepth.spec.pixel import PixelFormat


class Spot(AnyCriterion):
    """Criterion: ``|left - right|`` of red, or of gray."""

    kind: Literal["spot"] = "spot"  # pyright: ignore[reportIncompatibleVariableOverride]
    label_bits: int = Field(default=8, ge=4, le=20)

    def maximum_of(self, pixel: PixelFormat) -> int:
        """White against black."""
        return pixel.maximum


class SpotValues:
    """The criterion over a frame."""

    first_column = 0

    def __init__(self, criterion: Spot, left: Image, right: Image, bits: int) -> None:
        self._left, self._right = (view[:, :, 0].astype(np.int32) for view in (left, right))

    def band(self, first: int, stop: int) -> Callable[[int], Values]:
        """See `softdepth.golden.costs.criteria.FrameValues`."""
        left, right = self._left[first:stop], self._right[first:stop]
        return lambda d: np.abs(left[:, d:] - right[:, : right.shape[1] - d])


CRITERIA.register("spot", Spot)
EVALUATE.register("spot", SpotValues)
