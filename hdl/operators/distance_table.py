"""A small table looked up by how far a sum lies from a number."""

from collections.abc import Sequence

from amaranth.hdl import Array, Cat, Const, Mux, Shape, Value

from softdepth.hdl.operators.cell import constant, reaches
from softdepth.hdl.pipeline import Pipeline, Word
from softdepth.hdl.wires import choose, flag

SHORT_BITS = 6
"""Up to so many low bits of a sum are looked up as they are."""


class DistanceTable:
    """``table[|word - zero|]``, plus a constant on either side of `zero`.

    A short table is selected from by the word's own low bits: then no magnitude has to be made, and
    the constants take no addition.

    Parameters
    ----------
    table : its last entry holds for every larger distance.
    one : the membership that is 1.0; words are looked up around it, or around 0.

    Members
    -------
    operations : in a row from the word to the entry.
    """

    def __init__(self, table: Sequence[int], one: int) -> None:
        self._table = table
        self._bits = max(1, (len(table) - 2).bit_length())
        self._short = self._bits <= SHORT_BITS and one >= 1 << self._bits
        self.operations = 1 if self._short else 3

    def lookup(
        self, pipeline: Pipeline, word: Word, split: int, *, zero: int, above: int = 0, below: int = 0
    ) -> Word:
        """The entry for ``|word - zero|``, plus `above` where ``word >= split``, and `below` elsewhere.

        `split` is 0 or `one`, and `zero` is `split` or 1 less.
        """
        upper = reaches(pipeline, word, split) if split else flag(pipeline, lambda v: ~v[-1], word)
        if not self._short:
            magnitude = pipeline.result(
                Mux(upper.value, word.value - zero, zero - word.value),
                0,
                max(word.maximum - zero, zero - word.minimum),
                word.time,
            )
            entry = pipeline.lookup(self._table, magnitude)
            side = choose(pipeline, upper, constant(above, word), constant(below, word))
            return pipeline.add(entry, side)

        size = 1 << self._bits
        sides = (range(-size, 0), below), (range(size), above)
        table = [self._entry(v + split - zero) + extra for values, extra in sides for v in values]
        last = [self._table[-1] + below, self._table[-1] + above]
        low, high = min(*table, *last), max(*table, *last)
        entries = Array(Const(entry, Shape.cast(range(low, high + 1))) for entry in table)
        rest = _signed(word.value) >> self._bits
        near = Mux(upper.value, rest == split >> self._bits, rest == (split >> self._bits) - 1)
        chosen = entries[Cat(word.value[: self._bits], upper.value)]
        beyond = Mux(upper.value, *reversed(last))
        return pipeline.result(Mux(near, chosen, beyond), low, high, word.time)

    def _entry(self, distance: int) -> int:
        return self._table[min(abs(distance), len(self._table) - 1)]


def _signed(value: Value) -> Value:
    return value if value.shape().signed else Cat(value, 0).as_signed()
