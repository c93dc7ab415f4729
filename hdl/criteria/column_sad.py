"""The absolute differences of one column, summed for each window height."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from amaranth.hdl import Const, Module, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import CHANNEL_BITS, CHANNELS
from softdepth.hdl.adders import Field, add_fields
from softdepth.hdl.pipeline import Pipeline, Word, clocks, start, tree_latency

CHANNEL_MAXIMUM = 2**CHANNEL_BITS - 1
ROW_OPERATIONS = 3
"""Operations of a row's cost: differences, red and green, blue."""


@dataclass(frozen=True)
class Difference:
    """``a - b - 1`` of two unsigned words, without its sign, and the sign: 1 where ``a > b``."""

    word: Word
    sign: Word

    def magnitude(self, pipeline: Pipeline, time: int) -> Word:
        """``|a - b| - sign``: the difference, or its one's complement, at ``time``."""
        word, sign = pipeline.at(self.word, time), pipeline.at(self.sign, time)
        return replace(word, value=~(word.value ^ sign.value.replicate(CHANNEL_BITS)))

    def complement(self) -> Word:
        """The one's complement of `magnitude`, when the difference is computed."""
        return replace(self.word, value=self.word.value ^ self.sign.value.replicate(CHANNEL_BITS))


@dataclass(frozen=True)
class Summand:
    """A word to be summed, and the 1 that may be missing from it: the carry of an adder to come."""

    word: Word
    missing: Word | None = None


class ColumnSad(wiring.Component):
    """Sums a column's absolute RGB differences over each window's height, one column a clock.

    ``|a - b|`` is ``a - b`` or its negation, which is one's complement and a 1. The complement is
    taken at the input of the adder that follows, and the 1 is that adder's carry, so that an absolute
    difference costs one subtraction: a column of n rows has one adder fewer than 3n differences, and
    one row computes a difference in full to make up for it.

    Parameters
    ----------
    windows : window heights in ascending order, all odd.

    Members
    -------
    left, right : the columns to compare, as high as the largest window, top first.
    o : ``c3, c5, ...``: the cost of the middle 3, 5, ... rows, `latency` clocks later.
    """

    def __init__(self, windows: Sequence[int]) -> None:
        self._windows = windows
        self._operations = _operations(windows)
        self.latency = clocks(self._operations)
        column = data.ArrayLayout(data.ArrayLayout(CHANNEL_BITS, CHANNELS), windows[-1])
        costs = {f"c{w}": range(column_maximum(w) + 1) for w in windows}
        super().__init__({"left": In(column), "right": In(column), "o": Out(data.StructLayout(costs))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        middle = self._windows[-1] // 2
        total: Summand | None = None
        inner = -1  # the largest row offset that is summed already
        for window in self._windows:
            radius = window // 2
            offsets = [offset for offset in range(-radius, radius + 1) if abs(offset) > inner]
            inner = radius
            summands = _rows(
                pipeline,
                start(self._operations),
                [(self.left[middle + offset], self.right[middle + offset]) for offset in offsets],
                exact_first=total is None,
            )
            ring = pipeline.tree(lambda a, b: _add(pipeline, a, b), summands)
            total = ring if total is None else _add(pipeline, total, ring)
            assert total.missing is None
            cost = pipeline.at(total.word, start(self._operations) + self._operations)
            m.d.comb += self.o[f"c{window}"].eq(cost.value)
        return m


def column_maximum(window: int) -> int:
    """The largest cost of a column as high as ``window``."""
    return window * CHANNELS * CHANNEL_MAXIMUM


def _operations(windows: Sequence[int]) -> int:
    """Operations in a row that the column costs take."""
    latency, inner = 0, 0
    for window in windows:
        added = ROW_OPERATIONS + tree_latency(window - inner)
        latency = max(latency, added) + 1 if inner else added
        inner = window
    return latency


def _rows(
    pipeline: Pipeline, time: int, pixels: Sequence[tuple[Value, Value]], exact_first: bool
) -> list[Summand]:
    """The cost of each row. The first is complete at once if it must be."""
    rows = [_differences(pipeline, time, left, right) for left, right in pixels]
    # Two inverted operands do not fit into a carry cell of ECP5, two complements of them do: the
    # complement of x + y + carry is the sum of their complements and the carry's.
    pairs = [_complement(red, green) for red, green, _ in rows]
    if exact_first:
        pairs.append(_complement(rows[0][2]))
    sums = [
        replace(word, value=~word.value, maximum=2 * CHANNEL_MAXIMUM) for word in add_fields(pipeline, pairs)
    ]
    triples = [
        Field(pair, blue.magnitude(pipeline, pair.time), pipeline.at(green.sign, pair.time))
        for pair, (_, green, blue) in zip(sums, rows, strict=False)
    ]
    if exact_first:
        triples[0] = replace(triples[0], b=sums[-1])
    return [
        Summand(row, None if exact_first and i == 0 else rows[i][2].sign)
        for i, row in enumerate(add_fields(pipeline, triples))
    ]


def _differences(pipeline: Pipeline, time: int, left: Value, right: Value) -> list[Difference]:
    """The differences of a pixel's channels, by one adder with a guard bit above each."""
    fields = [
        Field(*(pipeline.input(value, CHANNEL_MAXIMUM, time=time) for value in (left[c], ~right[c])))
        for c in range(CHANNELS)
    ]
    return [
        Difference(
            Word(word.value[:CHANNEL_BITS], 0, CHANNEL_MAXIMUM, word.time),
            Word(word.value[CHANNEL_BITS], 0, 1, word.time),
        )
        for word in add_fields(pipeline, fields)
    ]


def _complement(a: Difference, b: Difference | None = None) -> Field:
    """The one's complement of ``a + b`` but for the 1 that is missing from b; of ``a`` alone, whole."""
    other = b.complement() if b else replace(a.word, value=Const(CHANNEL_MAXIMUM, CHANNEL_BITS))
    return Field(a.complement(), other, replace(a.sign, value=~a.sign.value))


def _add(pipeline: Pipeline, a: Summand, b: Summand) -> Summand:
    """Their sum: what is missing from one of them comes in as its carry."""
    if a.missing is None:
        a, b = b, a
    (word,) = add_fields(pipeline, [Field(a.word, b.word, a.missing)])
    return Summand(word, b.missing)
