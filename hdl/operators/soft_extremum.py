"""Both soft minima in a cell (Bobyr et al. 2021, eqs. 5 and 6)."""

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.operators.cell import Corners, Position, complement, constant, order, reaches
from softdepth.hdl.operators.distance_table import DistanceTable
from softdepth.hdl.pipeline import Pipeline, Word
from softdepth.hdl.wires import choose, flag, inverted
from softdepth.soft import soft_min_1_table, soft_min_2_table


class SoftExtremum:
    """Theta as ``min(a, b) + g(|a - b|)`` or ``max(a, b) - h(|a - b|)``, each one carry chain.

    One distance, ``|b - c|``, serves both corners of a cell, and the other, ``|b + c - one|``, the two
    pairs between. The lower membership ``one - f`` is the complement of f and 1 more, which is part of
    the correction. All tables are looked up by the sum or difference itself.
    """

    def __init__(self, config: Config) -> None:
        self._one = one = config.one
        self._strengths = config.strength_range
        self._maximum = config.operator == "soft_min_2" and config.sharpness < 0
        if config.operator == "soft_min_1":
            table = soft_min_1_table(one, config.softness)
            # Monotone: lowest and highest at equal operands.
            self._pairs = table[0], one + table[0]
        else:
            table = soft_min_2_table(one, config.sharpness)
            # A weighted mean lies between its operands.
            self._pairs = 0, one
        self._table = DistanceTable([-entry for entry in table] if self._maximum else table, one)
        self.corner_operations = self._table.operations + 3
        self.fire_operations = self._table.operations + 2

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """See `CellOperator`."""
        one = self._one
        difference, smaller, larger = order(pipeline, b, c)
        total = pipeline.add(b, c)
        same = self._table.lookup(pipeline, difference, 0, zero=-1)
        lower, upper = (smaller, larger) if self._maximum else (larger, smaller)
        p0 = add_with_carry(pipeline, complement(pipeline, lower, one), same, constant(1, same), *self._pairs)
        p2 = pipeline.within(pipeline.add(upper, same), *self._pairs)

        # The pairs between are b and one - c, c and one - b. Their extreme is a corner's own operand, or
        # for the minimum its complement.
        extreme = choose(pipeline, reaches(pipeline, total, one), p2, p0)
        if self._maximum:
            mixed = self._table.lookup(pipeline, total, one, zero=one)
            p1 = pipeline.add(extreme, pipeline.subtract(mixed, same))
        else:
            mixed = self._table.lookup(pipeline, total, one, zero=one, above=1, below=1)
            p1 = pipeline.add(complement(pipeline, extreme, one), pipeline.add(mixed, same))
        return p0, pipeline.within(p1, *self._pairs), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        one = self._one
        below = pipeline.add(a.outer, inverted(pipeline, pair))
        outer_larger = flag(pipeline, lambda v: ~v[-1], below)
        total = pipeline.add(a.outer, pair)
        pair_larger = reaches(pipeline, total, one)  # than one - outer
        middle = complement(pipeline, a.outer, one)
        if self._maximum:
            operands = choose(pipeline, outer_larger, a.outer, pair), choose(pipeline, pair_larger, pair, middle)
        else:
            operands = choose(pipeline, outer_larger, pair, a.outer), choose(pipeline, pair_larger, middle, pair)
        corrections = (
            self._table.lookup(pipeline, below, 0, zero=-1),
            self._table.lookup(
                pipeline, total, one, zero=one, above=not self._maximum, below=self._maximum
            ),
        )
        outer, middle = (
            pipeline.within(pipeline.add(operand, correction), *self._strengths)
            for operand, correction in zip(operands, corrections, strict=True)
        )
        return outer, middle
