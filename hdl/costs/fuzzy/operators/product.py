"""PROD in a cell (Bobyr et al. 2021, eq. 3)."""

from dataclasses import replace

from softdepth.hdl.arithmetic.adders import add_with_carry
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline
from softdepth.hdl.arithmetic.wires import flag
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.operators.cell import Corners, Position, complement, order
from softdepth.spec.config import Config


class Product:
    """Theta as the product of the memberships; each of the two products is rounded half up.

    Memberships complement each other, so ``b (one - c) = one b - b c``, exact before it is rounded:
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
        product = b * c
        _, _, larger = order(b, c)
        p2 = pipeline.rounded(product, self._bits).within(0, one)
        p1 = self._less(larger, product)
        # (one - b) (one - c) = one (one - b - c) + b c
        linear = add_with_carry(complement(b, one), c.inverted, 1, -one - 1, one - 1)
        return add_with_carry(p2, linear, 1, 0, one), p1, p2

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """See `CellOperator`."""
        product = a.outer * pair
        outer = pipeline.rounded(product, self._bits).within(0, self._one)
        return outer, self._less(pair, product)

    def _less(self, word: Word, product: Word) -> Word:
        """``(one * word - product) / one``, rounded half up, which rounds the product's half down."""
        bits, one = self._bits, self._one
        whole = replace(product[bits:], maximum=one)
        up = flag(lambda v: v[bits - 1] & v[: bits - 1].any(), product)
        return add_with_carry(word, whole.inverted, ~up, 0, one)
