"""MEAN in a cell (Bobyr et al. 2021, eq. 4, of three operands)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.operators.cell import Corners, Position, complement, order
from softdepth.spec.config import Config


class CellMean:
    """Theta as the mean of the three memberships, times three: the third cancels in the ratio N/S."""

    corner_operations = 2
    fire_operations = 1

    def __init__(self, config: Config) -> None:
        self._one = config.one

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """``2 one - b - c``, ``one + |b - c|`` and ``b + c``."""
        one = self._one
        _, smaller, larger = order(b, c)
        p2 = b + c
        p0 = add_with_carry(complement(b, one), complement(c, one) + 1, 1, 0, 2 * one)
        p1 = add_with_carry(larger, complement(smaller, one), 1, one, 2 * one)
        return p0, p1, p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``outer + pair`` and ``middle + pair``."""
        return a.outer + pair, a.middle + pair
