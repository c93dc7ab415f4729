"""A small table looked up by how far a sum lies from 0."""

from collections.abc import Sequence

from amaranth.hdl import Array, Cat, Const, Mux, Shape

from softdepth.hdl.arithmetic.adders import magnitude
from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.arithmetic.wires import flag, wire

SHORT_BITS = 3
"""Up to so many low bits of a sum are looked up as they are, together with its sign."""


class DistanceTable:
    """``table[|sum|]`` of a signed sum; the last entry holds for every larger magnitude.

    Only the low bits of the magnitude that the table tells apart are made, and none for a short table,
    which is looked up by sum and sign.

    Members
    -------
    operations : in a row from the sum to the entry.
    """

    def __init__(self, table: Sequence[int]) -> None:
        self._table = table
        self._bits = max(1, (len(table) - 2).bit_length())
        self._short = self._bits <= SHORT_BITS
        self.operations = 1 if self._short else 2

    def lookup(self, pipeline: Pipeline, word: Word, less_1: bool = False) -> Word:
        """The entry for the magnitude of `word`, or of `word` plus 1 if it is one `less_1`."""
        bits = self._bits
        size = 1 << bits
        negative = flag(pipeline, lambda v: v[-1], word)
        far = flag(pipeline, lambda v: v[bits:] != v[-1].replicate(len(v) - bits), word)
        if self._short:
            values = [*range(size), *range(-size, 0)]
            low = wire(pipeline, lambda v: Cat(v[:bits], v[-1]), word, minimum=0, maximum=2 * size - 1)
            return self._select(pipeline, [abs(v + less_1) for v in values], low, far)
        distance = magnitude(pipeline, word, negative, bits, size, less_1=less_1)
        far = flag(pipeline, lambda f, v: f | v[bits], far, distance)
        low = wire(pipeline, lambda v: v[:bits], distance, minimum=0, maximum=size - 1)
        return self._select(pipeline, range(size), low, far)

    def _select(self, pipeline: Pipeline, magnitudes: Sequence[int], index: Word, far: Word) -> Word:
        """The entry of the indexed magnitude, or the last if it is `far`."""
        low, high = min(self._table), max(self._table)
        last = len(self._table) - 1
        entries = [Const(self._table[min(n, last)], Shape.cast(range(low, high + 1))) for n in magnitudes]
        index, far = pipeline.aligned(index, far)
        entry = Mux(far.value, self._table[-1], Array(entries)[index.value])
        return pipeline.result(entry, low, high, index.time, "entry")
