"""PROD in a cell (Bobyr et al. 2021, eq. 3)."""

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline, Word
from softdepth.hdl.arithmetic.wires import constant, flag, inverted, wire
from softdepth.hdl.costs.fuzzy.operators.cell import Corners, Position, complement, order
from softdepth.spec.config import Config


class Product:
    """Theta as the product of the memberships; each of the two products is rounded half up.

    Memberships complement each other, so that ``b (one - c) = one b - b c``, exact before it is rounded:
    one multiplier serves all pairs of a cell, and one a pair both its rules. `Config.multipliers`
    counts these four, of ``membership_bits + 1`` bits a side.
    """

    corner_operations = 2 * LEVELS + 2
    fire_operations = 2 * LEVELS + 1

    def __init__(self, config: Config) -> None:
        self._bits = config.membership_bits
        self._one = config.one

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """See `CellOperator`."""
        one = self._one
        product = pipeline.multiply(b, c)
        _, _, larger = order(pipeline, b, c)
        p2 = pipeline.within(pipeline.rounded(product, self._bits), 0, one)
        p1 = self._less(pipeline, larger, product)
        # (one - b) (one - c) = one (one - b - c) + b c
        rest = complement(pipeline, b, one), inverted(pipeline, c)
        linear = add_with_carry(pipeline, *rest, constant(1, b), -one - 1, one - 1)
        return add_with_carry(pipeline, p2, linear, constant(1, p2), 0, one), p1, p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        product = pipeline.multiply(a.outer, pair)
        outer = pipeline.within(pipeline.rounded(product, self._bits), 0, self._one)
        return outer, self._less(pipeline, pair, product)

    def _less(self, pipeline: Pipeline, word: Word, product: Word) -> Word:
        """``(one * word - product) / one``, rounded half up, which rounds the product's half down."""
        bits, one = self._bits, self._one
        whole = wire(pipeline, lambda v: v[bits:], product, minimum=0, maximum=one)
        up = flag(pipeline, lambda v: v[bits - 1] & v[: bits - 1].any(), product)
        return add_with_carry(
            pipeline, word, inverted(pipeline, whole), flag(pipeline, lambda v: ~v, up), 0, one
        )
