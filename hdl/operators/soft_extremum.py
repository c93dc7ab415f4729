"""Both soft minima in a cell (Bobyr et al. 2021, eqs. 5 and 6)."""

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.operators.cell import Corners, Position, complement, constant, excess
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
        lower, upper = (b, c) if keeps else (c, b)
        lower, upper = choose(pipeline, c_larger, lower, upper), choose(pipeline, c_larger, upper, lower)
        p0 = add_with_carry(pipeline, complement(pipeline, lower, one), same, constant(1, same), *self._pairs)
        p2 = pipeline.within(pipeline.add(upper, same), *self._pairs)

        # The pairs between are b and one - c, c and one - b. Their extreme is a corner's own operand, or
        # for the minimum its complement.
        extreme = choose(pipeline, flag(pipeline, lambda v: v[-1], pipeline.at(sum_, p0.time)), p0, p2)
        extreme = extreme if keeps else complement(pipeline, extreme, one)
        same = inverted(pipeline, same) if keeps else same
        low, high = mixed.minimum + same.minimum + 1, mixed.maximum + same.maximum + 1
        correction = add_with_carry(pipeline, mixed, same, constant(1, same), low, high)
        return p0, pipeline.within(pipeline.add(extreme, correction), *self._pairs), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        one = self._one
        difference = pipeline.add(a.outer, inverted(pipeline, pair))  # less 1
        sum_ = excess(pipeline, a.outer, pair, one)
        in_f = self._table.lookup(pipeline, difference, less_1=True)
        in_g = self._table.lookup(pipeline, sum_)

        difference, sum_, outer, pair = (
            pipeline.at(word, in_f.time) for word in (difference, sum_, a.outer, pair)
        )
        middle = complement(pipeline, outer, one)
        takes_pair_f = flag(pipeline, lambda v: v[-1] if self._maximum else ~v[-1], difference)
        takes_pair_g = flag(pipeline, lambda v: ~v[-1] if self._maximum else v[-1], sum_)
        f = pipeline.add(choose(pipeline, takes_pair_f, pair, outer), in_f)
        g = add_with_carry(
            pipeline,
            choose(pipeline, takes_pair_g, pair, middle),
            in_g,
            flag(pipeline, lambda taken: ~taken, takes_pair_g),  # which the complement lacks
            *self._strengths,
        )
        return pipeline.within(f, *self._strengths), g
