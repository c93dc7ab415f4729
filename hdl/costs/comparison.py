"""What a criterion that is summed down columns compares, and over which rows and columns it sums."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from amaranth.hdl import Shape, Signal
from amaranth.lib import wiring

from softdepth.hdl.costs.criteria.unlikeness import ColourDifference, GradientDifference, Hamming
from softdepth.hdl.front.descriptor import CENSUS, Descriptor, colour, gradient
from softdepth.hdl.thresholds import threshold
from softdepth.spec.config import Config, PixelFormat
from softdepth.spec.criteria import (
    GRADIENT_CAP,
    RECIPROCAL_BITS,
    SUPPORT_SHIFT,
    AnyCriterion,
    Census,
    Gradient,
    Sad,
)
from softdepth.spec.registry import Registry

LIKE_BITS = 8
"""Bits of the values by which a configuration says which colours are alike."""


@dataclass(frozen=True)
class Comparison:
    """A criterion as the gateware sees it.

    Members
    -------
    descriptor : what it compares.
    rows : rows that are summed.
    reach : columns on either side of the window's centre.
    pixel_maximum : the largest difference of a pixel.
    block, parameters : the component that compares two descriptors, with the ports of `Hamming`.
    dx : columns from the pixel to the window's centre, to the right.
    spacing, taps, like : of a support: its columns, and which colours count; ``taps`` is 0 without one.
    own_shift : bits by which the value is shifted above the sum.
    limit : of its differences, if a register may set it (`softdepth.hdl.thresholds`); ``block`` takes it by
        this name.
    running : sums down the columns are kept; one row enters and one leaves.
    lags : how far above the newest row those lie that are compared, ascending: for a running sum the one that
        enters and the one that leaves, else all that are summed; set by `plan`.
    """

    descriptor: Descriptor
    rows: int
    reach: int
    pixel_maximum: int
    block: Callable[..., wiring.Component]
    parameters: tuple[Any, ...]
    dx: int = 0
    taps: int = 0
    spacing: int = 0
    like: int = 0
    own_shift: int = 0
    limit: Signal | None = dataclasses.field(default=None, compare=False)
    running: bool = True
    lags: tuple[int, ...] = ()

    @property
    def field(self) -> str:
        """The descriptor's name."""
        return self.descriptor.name

    @property
    def shape(self) -> Shape:
        """The descriptor's shape."""
        return self.descriptor.shape

    @property
    def column_maximum(self) -> int:
        """The largest sum of a column."""
        return self.rows * self.pixel_maximum

    @property
    def ahead(self) -> int:
        """Columns to the right of the pixel on which its value depends; negative if there are none."""
        return self.reach + self.dx

    @property
    def column(self) -> tuple[Any, ...]:
        """What its columns are made of; criteria that have this in common share their sums."""
        told = self.limit is not None
        return self.field, self.lags, self.running, self.block, self.parameters, told

    def differences(self) -> wiring.Component:
        """A block that compares two descriptors."""
        limit = {} if self.limit is None else {"limit": self.limit}
        return self.block(*self.parameters, **limit)


COMPARISONS: Registry[Callable[[Any, PixelFormat], Comparison]] = Registry("criterion's comparison")
"""For each kind that is summed down columns: its comparison, from the criterion and the pixel format."""


def _census(criterion: Census, pixel: PixelFormat) -> Comparison:
    taps, spacing = (criterion.taps, criterion.spacing) if criterion.taps > 1 else (0, 0)
    return Comparison(
        descriptor=CENSUS,
        rows=criterion.rows,
        reach=taps // 2 * spacing,
        pixel_maximum=criterion.bits,
        block=Hamming,
        parameters=(criterion.bits, criterion.neutral),
        taps=taps,
        spacing=spacing,
        like=criterion.like,
        own_shift=RECIPROCAL_BITS - SUPPORT_SHIFT,  # a column by itself counts as a mean of one
        running=criterion.running_sums,
    )


def _gradient(criterion: Gradient, pixel: PixelFormat) -> Comparison:
    return _of_gradient(
        criterion.cap,
        criterion.truncation,
        criterion.neutral,
        limit=threshold("truncation", None),
        rows=criterion.rows,
        reach=criterion.columns // 2,
        running=criterion.running_sums,
    )


def _of_gradient(cap: int, truncation: int, neutral: int, **window: Any) -> Comparison:
    descriptor = gradient(cap)
    return Comparison(
        descriptor=descriptor,
        pixel_maximum=max(min(truncation, 2 * cap), neutral),
        block=GradientDifference,
        parameters=(descriptor.shape, 2 * cap, truncation, neutral),
        **window,
    )


def _sad(criterion: Sad, pixel: PixelFormat) -> Comparison:
    """No result depends on what lies outside the frame, nor on candidates without a partner."""
    window: dict[str, Any] = {"rows": criterion.window, "reach": criterion.radius, "dx": criterion.dx}
    if criterion.source == "gradient":
        return _of_gradient(GRADIENT_CAP, 2 * GRADIENT_CAP, 0, **window)
    return Comparison(
        descriptor=colour(pixel.size),
        pixel_maximum=pixel.channels * pixel.maximum,
        block=ColourDifference,
        parameters=(pixel.channels, pixel.bits),
        **window,
    )


COMPARISONS.register("census", _census)
COMPARISONS.register("gradient", _gradient)
COMPARISONS.register("sad", _sad)


FEW_COLUMNS = 5
"""Up to this many columns along a row are added anew; a running sum takes two additions and a memory."""


@dataclass(frozen=True)
class Plan:
    """All comparisons of a core, and how far they reach together."""

    comparisons: tuple[Comparison, ...]
    below: int
    right: int
    history: int

    def row_runs(self, comparison: Comparison) -> bool:
        """Whether a comparison's sum along the row is a running one: it adds a column and drops one."""
        columns = 2 * comparison.reach + 1
        return not comparison.taps and columns > FEW_COLUMNS and self.right == comparison.ahead

    @property
    def has_support(self) -> bool:
        """Some comparison has a support, for which whole colours are compared."""
        return any(c.taps for c in self.comparisons)

    @property
    def rows(self) -> dict[str, tuple[int, ...]]:
        """For each descriptor, how far above the newest row it is wanted, ascending."""
        found: dict[str, set[int]] = {}
        for c in self.comparisons:
            found.setdefault(c.field, set()).update(c.lags)
        return {field: tuple(sorted(rows)) for field, rows in found.items()}

    @property
    def descriptors(self) -> dict[str, Descriptor]:
        """All descriptors that are compared, by name."""
        return {c.field: c.descriptor for c in self.comparisons}

    @property
    def columns(self) -> tuple[Comparison, ...]:
        """The comparisons whose columns are summed: the first of those that share their columns."""
        return tuple({c.column: c for c in reversed(self.comparisons)}[key] for key in self._keys)

    @property
    def _keys(self) -> list[tuple[Any, ...]]:
        return list(dict.fromkeys(c.column for c in self.comparisons))

    def column_of(self, comparison: Comparison) -> str:
        """Which of `columns` has its column sums."""
        return str(self._keys.index(comparison.column))


MINIMUM_RIGHT = 4
"""The fewest slots that a line has beyond its pixels. In shorter lines, running sums would look up a
place before the row above is done with it."""


def by_windows(config: Config) -> bool:
    """Whether a core compares windows of plain pixels: windows of colours, and no stages behind the winners.

    Their support has more than one row.
    """
    return (
        not config.post.any
        and config.reach_rows > 0
        and (config.cost == "fuzzy" or len(config.criteria) == 1)
        and all(_of_pixels(c) for c in config.criteria)
    )


def _of_pixels(criterion: AnyCriterion) -> bool:
    return criterion.kind not in COMPARISONS or (isinstance(criterion, Sad) and criterion.source == "colour")


def plan(config: Config) -> Plan:
    """The comparisons of a configuration whose criteria are summed down columns."""
    stated = [COMPARISONS[c.kind](c, config.pixel) for c in config.criteria]
    below = max(c.rows // 2 for c in stated)
    found = tuple(replace(c, lags=_lags(c, below)) for c in stated)
    right = max(MINIMUM_RIGHT, *(c.ahead for c in found))
    return Plan(found, below, right, max(c.lags[-1] for c in found))


def _lags(comparison: Comparison, below: int) -> tuple[int, ...]:
    first = below - comparison.rows // 2
    behind = first + comparison.rows
    return (first, behind) if comparison.running else tuple(range(first, behind))
