"""What a criterion without a border band compares, and over which rows and columns it sums."""

from dataclasses import dataclass
from typing import cast

from amaranth.hdl import Shape, unsigned

from softdepth.hdl.costs.criteria.unlikeness import GradientDifference, Hamming
from softdepth.spec.config import Config
from softdepth.spec.criteria import RECIPROCAL_BITS, SUPPORT_SHIFT, Census, Gradient

LIKE_BITS = 8
"""Bits of the values in which a configuration says what colours are alike."""


@dataclass(frozen=True)
class Comparison:
    """A criterion as the gateware sees it.

    Members
    -------
    field : which descriptor.
    shape : of that.
    new, old : rows above the newest of that which enters its sums and that which leaves them.
    reach : columns to either side of the pixel.
    spacing, taps : with a support: its columns; ``taps`` is 0 without.
    """

    criterion: Census | Gradient
    field: str
    shape: Shape
    new: int
    old: int
    reach: int
    taps: int
    spacing: int

    @property
    def pixel_maximum(self) -> int:
        """The largest difference of a pixel."""
        if isinstance(self.criterion, Census):
            return self.criterion.bits
        return max(min(self.criterion.truncation, 2 * self.criterion.cap), self.criterion.neutral)

    @property
    def own_shift(self) -> int:
        """Bits by which the value is more than the sum: a column alone counts as a mean of one."""
        return RECIPROCAL_BITS - SUPPORT_SHIFT if isinstance(self.criterion, Census) else 0

    @property
    def column_maximum(self) -> int:
        """The largest sum of a column."""
        return self.criterion.rows * self.pixel_maximum

    def differences(self) -> Hamming | GradientDifference:
        """A block that compares two descriptors."""
        if isinstance(self.criterion, Census):
            return Hamming(self.criterion.bits, self.criterion.neutral)
        largest, cut = 2 * self.criterion.cap, self.criterion.truncation
        return GradientDifference(self.shape, largest, cut, self.criterion.neutral)


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
    criteria = cast("tuple[Census | Gradient, ...]", config.criteria)
    below = max(c.rows // 2 for c in criteria)
    found = []
    for number, criterion in enumerate(criteria):
        rows = criterion.rows // 2
        if isinstance(criterion, Census):
            taps, spacing = (criterion.taps, criterion.spacing) if criterion.taps > 1 else (0, 0)
            reach, shape, field = taps // 2 * spacing, unsigned(criterion.bits), "census"
        else:
            taps = spacing = 0
            reach, field = criterion.columns // 2, f"gradient_{number}"
            shape = Shape.cast(range(-criterion.cap, criterion.cap + 1))
        found.append(
            Comparison(criterion, field, shape, below - rows, below + rows + 1, reach, taps, spacing)
        )
    right = max(MINIMUM_RIGHT, *(c.reach for c in found))
    return Plan(tuple(found), below, right, max(c.old for c in found))
