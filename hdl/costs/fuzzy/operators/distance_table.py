"""A small table looked up by how far a sum lies from 0."""

from collections.abc import Callable, Sequence

from amaranth.hdl import Array, Cat, Const, Mux, Shape

from softdepth.hdl.arithmetic.adders import distance, magnitude
from softdepth.hdl.arithmetic.wires import flag, wire
from softdepth.hdl.arithmetic.word import Word

SHORT_BITS = 3
"""Up to this many low bits of a sum are looked up directly, together with its sign."""


class DistanceTable:
    """``table[|sum|]`` of a signed sum; the last entry holds for every larger magnitude.

    Only the low bits of the magnitude that the table distinguishes are computed; a short table needs none of
    them and is looked up by sum and sign.

    Members
    -------
    operations : in a row from the sum to the entry.
    """

    def __init__(self, table: Sequence[int]) -> None:
        self._table = table
        self._bits = max(1, (len(table) - 2).bit_length())
        self._short = self._bits <= SHORT_BITS
        self.operations = 1 if self._short else 2

    def of_magnitude(self, word: Word) -> Word:
        """The entry for ``|word|``."""
        return self._lookup(word, magnitude, 0)

    def of_distance(self, less_1: Word) -> Word:
        """The entry for ``|a - b|``, of ``a - b - 1``."""
        return self._lookup(less_1, distance, 1)

    def _lookup(self, word: Word, fold: Callable[[Word, Word, int, int], Word], missing: int) -> Word:
        bits = self._bits
        size = 1 << bits
        far = flag(lambda v: v[bits:] != v[-1].replicate(len(v) - bits), word)
        if self._short:
            values = [*range(size), *range(-size, 0)]
            low = wire(lambda v: Cat(v[:bits], v[-1]), word, minimum=0, maximum=2 * size - 1)
            return self._select([abs(v + missing) for v in values], low, far)
        folded = fold(word, word.negative, bits, size)
        return self._select(range(size), folded[:bits], far | folded[bits])

    def _select(self, magnitudes: Sequence[int], index: Word, far: Word) -> Word:
        """The entry of the indexed magnitude, or the last if it is `far`."""
        low, high = min(self._table), max(self._table)
        last = len(self._table) - 1
        entries = [Const(self._table[min(n, last)], Shape.cast(range(low, high + 1))) for n in magnitudes]
        pipeline = index.pipeline
        index, far = pipeline.aligned(index, far)
        entry = Mux(far.value, self._table[-1], Array(entries)[index.value])
        return pipeline.result(entry, low, high, index.time, "entry")
