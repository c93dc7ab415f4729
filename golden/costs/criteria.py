"""The criteria of a candidate: the numbers that say how unlike two windows are."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from softdepth.golden.costs.census import CensusValues
from softdepth.golden.costs.gradient import GradientValues
from softdepth.golden.costs.sad import SadValues
from softdepth.golden.costs.values import Values
from softdepth.golden.front.pair import Image
from softdepth.spec.config import Config
from softdepth.spec.registry import Registry

__all__ = ["EVALUATE", "FrameCriteria", "Values", "compensate"]


class FrameValues(Protocol):
    """One criterion over a frame; it yields one band of rows after another.

    Members
    -------
    first_column : the first column whose pixels have their whole window.
    """

    first_column: int

    def band(self, first: int, stop: int) -> Callable[[int], Values]:
        """The function from a candidate d to the values of rows ``first .. stop - 1``.

        It covers the pixels whose whole window lies inside the image, and their partner's too: the first is
        in column ``first_column + d``.
        """
        ...


EVALUATE: Registry[Callable[[Any, Image, Image, int], FrameValues]] = Registry("model of a criterion")
"""What computes each `kind`, from (criterion, left, right, bits of a channel) of a whole frame."""

EVALUATE.register("sad", SadValues)
EVALUATE.register("census", CensusValues)
EVALUATE.register("gradient", GradientValues)


class FrameCriteria:
    """All criteria of a frame's pixels.

    Parameters
    ----------
    left, right : the views as the core sees them, rows x columns x channels.
    """

    def __init__(self, config: Config, left: Image, right: Image) -> None:
        self._config = config
        self._width = left.shape[1]
        self._parts = [EVALUATE[c.kind](c, left, right, config.pixel.bits) for c in config.criteria]

    def band(self, first: int, stop: int) -> Callable[[int], list[Values]]:
        """The function from a candidate d to all criteria of rows ``first .. stop - 1``.

        Each is rows x (columns - d), where columns are those with a result: candidate d is excluded in the
        first d of them.
        """
        config = self._config
        parts = [part.band(first, stop) for part in self._parts]
        columns = self._width - config.reach_left - config.reach_right
        # A smaller window has values in the border band of the largest.
        starts = [config.reach_left - part.first_column for part in self._parts]

        def values(d: int) -> list[Values]:
            return [
                part(d)[:, start : start + columns - d] for part, start in zip(parts, starts, strict=True)
            ]

        return values


def compensate(config: Config, d: int, values: list[Values], replacement: list[int]) -> list[Values]:
    """The compensating rule: ``if d >= from_disparity and SAD > threshold, s_i := replacement_i``.

    SAD is that of `Config.compensation_criterion`, compared before anything saturates (paper,
    section 4, step 3).
    """
    rule = config.compensation
    if rule.reading == "off" or d < rule.from_disparity:
        return values
    assert config.compensation_criterion is not None  # the configuration has checked it
    fires = values[config.compensation_criterion] > rule.threshold
    return [np.where(fires, np.int32(r), s) for s, r in zip(values, replacement, strict=True)]
