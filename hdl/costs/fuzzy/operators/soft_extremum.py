"""Both soft minima in a cell (Bobyr et al. 2021, eqs. 5 and 6)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.arithmetic.wires import choose, constant, flag, inverted, masked
from softdepth.hdl.costs.fuzzy.operators.cell import Corners, Position, complement, excess
from softdepth.hdl.costs.fuzzy.operators.distance_table import DistanceTable
from softdepth.spec.config import Config
from softdepth.spec.soft import soft_min_1_table, soft_min_2_table


class SoftExtremum:
    """Theta as ``min(a, b) + g(|a - b|)`` or ``max(a, b) - h(|a - b|)``.

    One distance, ``|b - c|``, serves both corners of a cell, and the other, ``|b + c - one|``, the two
    pairs between; all tables are looked up by the difference or sum itself. Choosing an operand and
    correcting it is one carry chain.
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
        self._table = DistanceTable([-entry for entry in table] if self._maximum else table)
        self.corner_operations = self._table.operations + 3
        self.fire_operations = self._table.operations + 2

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """See `CellOperator`."""
        one, keeps = self._one, self._maximum
        difference = pipeline.add(b, inverted(pipeline, c))  # less 1
        sum_ = excess(pipeline, b, c, one)
        same = self._table.lookup(pipeline, difference, less_1=True)
        mixed = self._table.lookup(pipeline, sum_)

        # What is chosen goes straight into an addition: registers come before the choice.
        difference, b, c = (pipeline.at(word, same.time) for word in (difference, b, c))
        c_larger = flag(pipeline, lambda v: v[-1], difference)
        smaller, larger = choose(pipeline, c_larger, b, c), choose(pipeline, c_larger, c, b)
        p2 = pipeline.within(pipeline.add(larger if keeps else smaller, same), *self._pairs)
        # one - b and one - c are c and b, less what b + c exceeds one by.
        p0 = _less(pipeline, p2, sum_, *self._pairs)
        short = flag(pipeline, lambda v: v[-1], sum_)
        p1 = pipeline.add(larger, mixed)
        sum_, short = pipeline.at(sum_, p1.time), pipeline.at(short, p1.time)
        return p0, _less(pipeline, p1, masked(pipeline, sum_, short, keep=keeps), *self._pairs), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        one, keeps = self._one, self._maximum
        difference = pipeline.add(a.outer, inverted(pipeline, pair))  # less 1
        sum_ = excess(pipeline, a.outer, pair, one)
        in_f = self._table.lookup(pipeline, difference, less_1=True)
        in_g = self._table.lookup(pipeline, sum_)

        # A carry cell has room for a choice of a complement only where 0 chooses the other operand.
        takes_middle = pipeline.at(flag(pipeline, lambda v: v[-1] == keeps, sum_), in_g.time)
        outer, pair = pipeline.at(a.outer, in_f.time), pipeline.at(pair, in_f.time)
        takes_pair = flag(pipeline, lambda v: v[-1] == keeps, pipeline.at(difference, in_f.time))
        f = pipeline.add(choose(pipeline, takes_pair, pair, outer), in_f)
        middle = complement(pipeline, outer, one)  # less 1
        g = add_with_carry(
            pipeline, choose(pipeline, takes_middle, middle, pair), in_g, takes_middle, *self._strengths
        )
        return pipeline.within(f, *self._strengths), g


def _less(pipeline: Pipeline, a: Word, b: Word, minimum: int, maximum: int) -> Word:
    """``a - b``, known to lie within a range."""
    return add_with_carry(pipeline, a, inverted(pipeline, b), constant(1, a), minimum, maximum)
