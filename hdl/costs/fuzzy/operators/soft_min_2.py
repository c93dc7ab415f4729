"""Soft-min II (Bobyr et al. 2021, eq. 6) of two operands, nested."""

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.operators.compare import compare
from softdepth.spec.config import Config
from softdepth.spec.soft import soft_min_2_table


class SoftMin2:
    """Theta as the minimum plus (k > 0), or the maximum minus (k < 0), a small table of ``|a - b|``.

    It is not monotone: where the table falls, a step of one in an operand may lower it by one. The rule
    array joins rules before Theta all the same: for this operator, that order is the definition (as in
    the fixed model).
    """

    pair_operations = 4
    fire_operations = 4

    def __init__(self, config: Config) -> None:
        self._soft_maximum = config.sharpness < 0
        table = soft_min_2_table(config.one, config.sharpness)
        self._table = [-entry for entry in table] if self._soft_maximum else table

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``min(b, c) + h(|b - c|)`` or ``max(b, c) - h(|b - c|)``."""
        first_smaller, distance = compare(b, c)
        correction = pipeline.lookup(self._table, distance)
        operands = (c, b) if self._soft_maximum else (b, c)
        strength = correction + choose(first_smaller, *operands)
        # A weighted mean lies between its operands.
        return strength.within(min(b.minimum, c.minimum), max(b.maximum, c.maximum))

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """The same, of criterion 1's membership and a pair."""
        return self.pair(pipeline, a, pair)
