"""MIN in a cell (Bobyr et al. 2021, eq. 2)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose
from softdepth.hdl.arithmetic.word import Word
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
        _, p2, _ = order(b, c)
        sum_ = excess(b, c, one)
        p0 = add_with_carry(p2, sum_.inverted, 1, 0, one)
        rest = complement(choose(sum_.negative, p0, p2), one)  # of the larger one, less 1
        return p0, add_with_carry(rest, pipeline.constant(0, rest.time), 1, 0, one), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``min(outer, pair)`` and ``min(middle, pair)``."""
        f = choose(a.outer > pair, pair, a.outer)
        g = choose(excess(a.outer, pair, self._one).negative, pair, a.middle)
        return (
            pipeline.result(f.value, 0, self._one, f.time, "fires_outer"),
            pipeline.result(g.value, 0, self._one, g.time, "fires_middle"),
        )
