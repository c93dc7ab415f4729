"""MIN in a cell (Bobyr et al. 2021, eq. 2)."""

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.operators.cell import Corners, Position, complement, constant, order, reaches
from softdepth.hdl.pipeline import Pipeline, Word
from softdepth.hdl.wires import choose, flag, inverted


class Minimum:
    """Theta as the smallest of the three memberships; see `CellOperator`."""

    corner_operations = 3
    fire_operations = 1

    def __init__(self, config: Config) -> None:
        self._one = config.one

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """``one - max(b, c)``, ``min(max(b, c), one - min(b, c))`` and ``min(b, c)``."""
        one = self._one
        _, p2, larger = order(pipeline, b, c)
        total = pipeline.add(b, c)
        p0 = self._rest(pipeline, larger)
        p1 = self._rest(pipeline, choose(pipeline, reaches(pipeline, total, one), p2, p0))
        return p0, p1, p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """``min(outer, pair)`` and ``min(middle, pair)``."""
        difference = pipeline.add(a.outer, inverted(pipeline, pair))
        outer_larger = flag(pipeline, lambda v: ~v[-1], difference)
        pair_larger = reaches(pipeline, pipeline.add(a.outer, pair), self._one)
        return choose(pipeline, outer_larger, pair, a.outer), choose(pipeline, pair_larger, a.middle, pair)

    def _rest(self, pipeline: Pipeline, word: Word) -> Word:
        """``one - word``."""
        inverse = complement(pipeline, word, self._one)
        return add_with_carry(pipeline, inverse, constant(0, word), constant(1, word), 0, self._one)
