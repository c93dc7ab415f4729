"""MIN in a cell (Bobyr et al. 2021, eq. 2)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.arithmetic.wires import choose, constant, flag, inverted
from softdepth.hdl.costs.fuzzy.operators.cell import Corners, Position, complement, excess, order
from softdepth.spec.config import Config


class Minimum:
    """Theta as the smallest of the three memberships; see `CellOperator`."""

    corner_operations = 3
    fire_operations = 2

    def __init__(self, config: Config) -> None:
        self._one = config.one

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """``one - max(b, c)``, ``min(max(b, c), one - min(b, c))`` and ``min(b, c)``."""
        one = self._one
        _, p2, _ = order(pipeline, b, c)
        sum_ = excess(pipeline, b, c, one)
        short = flag(pipeline, lambda v: v[-1], sum_)
        p0 = add_with_carry(pipeline, p2, inverted(pipeline, sum_), constant(1, p2), 0, one)
        rest = complement(pipeline, choose(pipeline, short, p0, p2), one)  # of the larger one, less 1
        return p0, add_with_carry(pipeline, rest, constant(0, p0), constant(1, p0), 0, one), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``min(outer, pair)`` and ``min(middle, pair)``."""
        pair_smaller = flag(pipeline, lambda v: ~v[-1], pipeline.add(a.outer, inverted(pipeline, pair)))
        pair_below_middle = flag(pipeline, lambda v: v[-1], excess(pipeline, a.outer, pair, self._one))
        f = choose(pipeline, pair_smaller, pair, a.outer)
        g = choose(pipeline, pair_below_middle, pair, a.middle)
        return pipeline.result(f.value, 0, self._one, f.time), pipeline.result(g.value, 0, self._one, g.time)
