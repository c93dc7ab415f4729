"""What a criterion without a border band compares, and over which rows and columns it sums."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from amaranth.hdl import Shape, unsigned
from amaranth.lib import wiring

from softdepth.hdl.costs.criteria.unlikeness import GradientDifference, Hamming
from softdepth.spec.config import Config
from softdepth.spec.criteria import RECIPROCAL_BITS, SUPPORT_SHIFT, Census, Gradient
from softdepth.spec.registry import Registry

LIKE_BITS = 8
"""Bits of the values in which a configuration says what colours are alike."""


@dataclass(frozen=True)
class Comparison:
    """A criterion as the gateware sees it.

    Members
    -------
    field : which descriptor; criteria of one core have different ones.
    shape : of that.
    rows : rows that are summed.
    reach : columns to either side of the pixel.
    pixel_maximum : the largest difference of a pixel.
    differences : makes a block that compares two descriptors, with the ports of `Hamming`.
    spacing, taps, like : with a support: its columns, and which colours count; ``taps`` is 0 without.
    own_shift : bits by which the value is more than the sum.
    cap : the bound of the gradient that is its descriptor; None where that is the census.
    new, old : rows above the newest of that which enters its sums and that which leaves them; by `plan`.
    """

    field: str
    shape: Shape
    rows: int
    reach: int
    pixel_maximum: int
    differences: Callable[[], wiring.Component]
    taps: int = 0
    spacing: int = 0
    like: int = 0
    own_shift: int = 0
    cap: int | None = None
    new: int = 0
    old: int = 0

    @property
    def column_maximum(self) -> int:
        """The largest sum of a column."""
        return self.rows * self.pixel_maximum


COMPARISONS: Registry[Callable[[Any, int], Comparison]] = Registry("criterion's comparison")
"""Of each kind without a border band: from the criterion, and its number in the configuration."""


def _census(criterion: Census, number: int) -> Comparison:
    taps, spacing = (criterion.taps, criterion.spacing) if criterion.taps > 1 else (0, 0)
    return Comparison(
        field="census",
        shape=unsigned(criterion.bits),
        rows=criterion.rows,
        reach=taps // 2 * spacing,
        pixel_maximum=criterion.bits,
        differences=lambda: Hamming(criterion.bits, criterion.neutral),
        taps=taps,
        spacing=spacing,
        like=criterion.like,
        own_shift=RECIPROCAL_BITS - SUPPORT_SHIFT,  # a column alone counts as a mean of one
    )


def _gradient(criterion: Gradient, number: int) -> Comparison:
    largest, cut = 2 * criterion.cap, criterion.truncation
    shape = Shape.cast(range(-criterion.cap, criterion.cap + 1))
    return Comparison(
        field=f"gradient_{number}",
        shape=shape,
        rows=criterion.rows,
        reach=criterion.columns // 2,
        pixel_maximum=max(min(cut, largest), criterion.neutral),
        differences=lambda: GradientDifference(shape, largest, cut, criterion.neutral),
        cap=criterion.cap,
    )


COMPARISONS.register("census", _census)
COMPARISONS.register("gradient", _gradient)


@dataclass(frozen=True)
class Plan:
    """All comparisons of a core, and how far they reach together."""

    comparisons: tuple[Comparison, ...]
    below: int
    right: int
    history: int

    @property
    def rows(self) -> dict[str, tuple[int, ...]]:
        """Of each descriptor, how many rows above the newest it is wanted, ascending."""
        found: dict[str, set[int]] = {}
        for c in self.comparisons:
            found.setdefault(c.field, set()).update((c.new, c.old))
        return {field: tuple(sorted(rows)) for field, rows in found.items()}


MINIMUM_RIGHT = 4
"""Slots that a line has beyond its pixels at least: running sums look a place up before the row above is done
where lines are shorter."""


def plan(config: Config) -> Plan:
    """The comparisons of a configuration whose criteria have no border band."""
    stated = [COMPARISONS[c.kind](c, number) for number, c in enumerate(config.criteria)]
    below = max(c.rows // 2 for c in stated)
    found = tuple(replace(c, new=below - c.rows // 2, old=below + c.rows // 2 + 1) for c in stated)
    right = max(MINIMUM_RIGHT, *(c.reach for c in found))
    return Plan(found, below, right, max(c.old for c in found))
