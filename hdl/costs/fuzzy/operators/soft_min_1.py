"""Soft-min I (Bobyr et al. 2021, eq. 5)."""

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.operators.compare import compare
from softdepth.spec.config import Config
from softdepth.spec.soft import soft_min_1_table


class SoftMin1:
    """Theta as the minimum plus a small table of ``|a - b|``, nested; it may go below zero.

    The table is monotone and grows by at most 1, so Theta is monotone, as the rule array needs.
    """

    pair_operations = 4
    fire_operations = 4

    def __init__(self, config: Config) -> None:
        self._table = soft_min_1_table(config.one, config.softness)

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``min(b, c) + g(|b - c|)``."""
        first_smaller, distance = compare(b, c)
        correction = pipeline.lookup(self._table, distance)
        strength = correction + choose(first_smaller, b, c)
        # Theta is monotone: its extremes lie at equal operands, where the correction is g(0).
        low = min(b.minimum, c.minimum) + self._table[min(abs(b.minimum - c.minimum), len(self._table) - 1)]
        high = min(b.maximum, c.maximum) + self._table[min(abs(b.maximum - c.maximum), len(self._table) - 1)]
        return strength.within(low, high)

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """The same, of criterion 1's membership and a pair."""
        return self.pair(pipeline, a, pair)
