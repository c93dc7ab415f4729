"""Both soft minima in a cell (Bobyr et al. 2021, eqs. 5 and 6)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose
from softdepth.hdl.arithmetic.word import Word
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
        difference = b + c.inverted  # less 1
        sum_ = excess(b, c, one)
        same = self._table.of_distance(difference)
        mixed = self._table.of_magnitude(sum_)

        # What is chosen goes straight into an addition: registers come before the choice.
        difference, b, c = (word.at(same.time) for word in (difference, b, c))
        c_larger = difference.negative
        smaller, larger = choose(c_larger, b, c), choose(c_larger, c, b)
        p2 = ((larger if keeps else smaller) + same).within(*self._pairs)
        # one - b and one - c are c and b, each less the amount by which b + c exceeds one.
        p0 = _less(p2, sum_, *self._pairs)
        p1 = larger + mixed
        sum_ = sum_.at(p1.time)
        less = choose(sum_.negative, sum_, 0) if keeps else choose(sum_.negative, 0, sum_)
        return p0, _less(p1, less, *self._pairs), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        one, keeps = self._one, self._maximum
        difference = a.outer + pair.inverted  # less 1
        sum_ = excess(a.outer, pair, one)
        in_f = self._table.of_distance(difference)
        in_g = self._table.of_magnitude(sum_)

        # A carry cell has room for a choice of a complement only where 0 chooses the other operand.
        takes_middle = (sum_.negative if keeps else ~sum_.negative).at(in_g.time)
        outer, pair = a.outer.at(in_f.time), pair.at(in_f.time)
        pair_larger = difference.at(in_f.time).negative
        f = choose(pair_larger if keeps else ~pair_larger, pair, outer) + in_f
        middle = complement(outer, one)  # less 1
        g = add_with_carry(choose(takes_middle, middle, pair), in_g, takes_middle, *self._strengths)
        return f.within(*self._strengths), g


def _less(a: Word, b: Word, minimum: int, maximum: int) -> Word:
    """``a - b``, known to lie within a range."""
    return add_with_carry(a, b.inverted, 1, minimum, maximum)
