"""MIN in a cell (Bobyr et al. 2021, eq. 2)."""

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.operators.cell import Corners, Position, complement, constant, excess, order
from softdepth.hdl.pipeline import Pipeline, Word
from softdepth.hdl.wires import choose, flag, inverted


class Minimum:
    """Theta as the smallest of the three memberships; see `CellOperator`."""

    corner_operations = 3
    fire_operations = 2

    def __init__(self, config: Config) -> None:
        self._one = config.one

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """``one - max(b, c)``, ``min(max(b, c), one - min(b, c))`` and ``min(b, c)``."""
        _, p2, larger = order(pipeline, b, c)
        short = flag(pipeline, lambda v: v[-1], excess(pipeline, b, c, self._one))
        p0 = self._rest(pipeline, larger)
        return p0, self._rest(pipeline, choose(pipeline, short, p0, p2)), p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``min(outer, pair)`` and ``min(middle, pair)``."""
        pair_smaller = flag(pipeline, lambda v: ~v[-1], pipeline.add(a.outer, inverted(pipeline, pair)))
        pair_below_middle = flag(pipeline, lambda v: v[-1], excess(pipeline, a.outer, pair, self._one))
        f = choose(pipeline, pair_smaller, pair, a.outer)
        g = choose(pipeline, pair_below_middle, pair, a.middle)
        return pipeline.result(f.value, 0, self._one, f.time), pipeline.result(g.value, 0, self._one, g.time)

    def _rest(self, pipeline: Pipeline, word: Word) -> Word:
        """``one - word``."""
        inverse = complement(pipeline, word, self._one)
        return add_with_carry(pipeline, inverse, constant(0, word), constant(1, word), 0, self._one)
