"""MEAN in a cell (Bobyr et al. 2021, eq. 4, of three operands)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.arithmetic.wires import constant
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
        _, smaller, larger = order(pipeline, b, c)
        p2 = pipeline.add(b, c)
        p0 = add_with_carry(
            pipeline,
            complement(pipeline, b, one),
            pipeline.add(complement(pipeline, c, one), constant(1, c)),
            constant(1, c),
            0,
            2 * one,
        )
        p1 = add_with_carry(
            pipeline, larger, complement(pipeline, smaller, one), constant(1, larger), one, 2 * one
        )
        return p0, p1, p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``outer + pair`` and ``middle + pair``."""
        return pipeline.add(a.outer, pair), pipeline.add(a.middle, pair)
