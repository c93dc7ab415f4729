"""The absolute differences of one column, summed for each window height."""

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace

from amaranth.hdl import Const, Module, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.adders import Field, add_fields
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline, clocks, start, tree_operations
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD, RowMemory
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import PixelFormat

STORED_READY = (RowMemory.latency - LOOKUP_AHEAD) * LEVELS
"""When the costs from memory are there, in operations after the columns."""


@dataclass(frozen=True)
class Difference:
    """``a - b - 1`` of two unsigned words, without its sign, and the sign: 1 where ``a > b``."""

    word: Word
    sign: Word

    def magnitude(self, time: int) -> Word:
        """``|a - b| - sign``: the difference, or its one's complement, at ``time``."""
        word, sign = self.word.at(time), self.sign.at(time)
        return replace(word, value=~(word.value ^ sign.value.replicate(len(word.value))))

    def complement(self) -> Word:
        """The one's complement of `magnitude`, when the difference is computed."""
        return replace(self.word, value=self.word.value ^ self.sign.value.replicate(len(self.word.value)))


@dataclass(frozen=True)
class Summand:
    """A word to be summed, and the 1 that may be missing from it: the carry of an adder to come."""

    word: Word
    missing: Word | None = None


class ColumnSad(wiring.Component):
    """Sums a column's absolute differences over each window's height, one column a clock.

    ``|a - b|`` is ``a - b`` or its negation, which is the one's complement plus 1. The complement is
    taken at the input of the adder that follows, and the 1 is that adder's carry, so an absolute
    difference costs one subtraction. A row whose last 1 goes to no adder computes a difference in full.

    Parameters
    ----------
    windows : window heights in ascending order, all odd.
    pixel : what is compared.
    stored_rows : rows whose costs come from memory. They are the upper ones; each was computed while
        it was lower in the column.
    places : columns of the longest line, times candidates of a pixel.

    Members
    -------
    valid, place : a column comes in `LOOKUP_AHEAD` clocks; which one of the line's, candidates counted
        separately.
    left, right : the columns to compare, top first, without the stored rows.
    o : ``c3, c5, ...``: the cost of the middle 3, 5, ... rows, `latency` clocks later.
    """

    def __init__(
        self, windows: Sequence[int], pixel: PixelFormat, stored_rows: int = 0, places: int = 1
    ) -> None:
        self._windows = windows
        self._pixel = pixel
        self._stored = stored_rows
        self._places = places
        # The rows from memory come at a fixed clock, and the computed ones with them. Without any, the
        # first operation is as late as it can be for the last to end in a register.
        sums = _sum_operations(windows)
        row = row_operations(pixel)
        ready = STORED_READY if stored_rows else start(row + sums) + row
        self._begin = min(ready - row, LEVELS - 1)  # in the columns' own clock
        self.latency = clocks(ready + sums)
        column = data.ArrayLayout(pixel_layout(pixel), windows[-1] - stored_rows)
        costs = {f"c{w}": range(column_maximum(w, pixel) + 1) for w in windows}
        super().__init__(
            {
                "valid": In(1),
                "place": In(range(places)),
                "left": In(column),
                "right": In(column),
                "o": Out(data.StructLayout(costs)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        rows = self._rows(m, pipeline)
        total: Summand | None = None
        inner = -1  # the largest row offset that is summed already
        for window in self._windows:
            radius = window // 2
            ring = pipeline.tree(
                _add,
                [row for offset, row in rows.items() if inner < abs(offset) <= radius],
            )
            inner = radius
            total = _add(total, ring) if total else ring
            assert total.missing is None
            cost = total.word.at(self.latency * LEVELS)
            m.d.comb += self.o[f"c{window}"].eq(cost.value)
        return m

    def _rows(self, m: Module, pipeline: Pipeline) -> dict[int, Summand]:
        """The cost of each row, by its offset from the middle."""
        radius = self._windows[-1] // 2
        newest = self._stored - radius  # of the rows that are remembered: the topmost computed one
        offsets = range(newest, radius + 1)
        # What is remembered must be complete, and so must one row of the innermost window.
        innermost = self._windows[0] // 2
        complete = {newest} if self._stored else set()
        if newest < -innermost or not complete:
            complete.add(-innermost)
        pixels = {o: (self.left[k], self.right[k]) for k, o in enumerate(offsets)}
        rows = _row_costs(pipeline, self._pixel, self._begin, pixels, complete)
        if self._stored:
            shape = range(column_maximum(1, self._pixel) + 1)
            m.submodules.memory = memory = RowMemory(shape, self._stored, self._places)
            time = STORED_READY
            m.d.comb += [
                memory.valid.eq(self.valid),
                memory.place.eq(self.place),
                memory.newest.eq(pipeline.at(rows[newest].word, time).value),
            ]
            for k, offset in enumerate(range(-radius, newest)):
                word = pipeline.input(memory.rows[k], column_maximum(1, self._pixel), f"row_{k}", time=time)
                rows[offset] = Summand(word)
        return rows


def column_maximum(window: int, pixel: PixelFormat) -> int:
    """The largest cost of a column as high as ``window``."""
    return window * pixel.channels * pixel.maximum


def row_operations(pixel: PixelFormat) -> int:
    """Operations of a row's cost: differences, red and green, blue; or of gray, and the 1 it may lack."""
    return pixel.channels if pixel.channels > 1 else 2


def _sum_operations(windows: Sequence[int]) -> int:
    """Operations in a row from the costs of the rows to those of the column."""
    operations, inner = 0, 0
    for window in windows:
        ring = tree_operations(window - inner)
        operations = max(operations, ring) + 1 if inner else ring
        inner = window
    return operations


def _row_costs(
    pipeline: Pipeline,
    pixel: PixelFormat,
    time: int,
    pixels: Mapping[int, tuple[Value, Value]],
    complete: Container[int],
) -> dict[int, Summand]:
    """The cost of each row of pixels. No 1 is missing from those that must be ``complete``."""
    rows = {offset: _differences(pipeline, pixel, time, *pair) for offset, pair in pixels.items()}
    ready = time + row_operations(pixel)
    if pixel.channels == 1:
        return {o: _gray_cost(gray, ready, whole=o in complete) for o, (gray,) in rows.items()}
    # Two inverted operands do not fit into an ECP5 carry cell, but two complements of them do: the
    # complement of x + y + carry is the sum of their complements and the carry's.
    first = {(offset, 0): _complement(red, green) for offset, (red, green, _) in rows.items()}
    first |= {(offset, 1): _complement(row[2]) for offset, row in rows.items() if offset in complete}
    sums = {
        key: replace(word, value=~word.value, maximum=2 * pixel.maximum)
        for key, word in zip(first, add_fields(list(first.values())), strict=True)
    }
    second = []
    for offset, (_, green, blue) in rows.items():
        pair = sums[offset, 0]
        whole = sums.get((offset, 1), blue.magnitude(pair.time))
        second.append(Field(pair, whole, green.sign.at(pair.time)))
    return {
        offset: Summand(
            replace(word, maximum=column_maximum(1, pixel)),
            None if offset in complete else rows[offset][2].sign,
        )
        for offset, word in zip(rows, add_fields(second), strict=True)
    }


def _gray_cost(gray: Difference, ready: int, *, whole: bool) -> Summand:
    """The cost of a gray pixel, one operation after its difference if it must be ``whole``."""
    if not whole:
        return Summand(gray.magnitude(ready), gray.sign.at(ready))
    part = gray.magnitude(ready - 1)
    (word,) = add_fields([Field(part, part.pipeline.constant(0, part.time), gray.sign.at(ready - 1))])
    return Summand(replace(word, value=word.value[: len(part.value)], maximum=part.maximum))


def _differences(
    pipeline: Pipeline, pixel: PixelFormat, time: int, left: Value, right: Value
) -> list[Difference]:
    """The differences of a pixel's channels, by one adder with a guard bit above each."""
    fields = [
        Field(*(pipeline.input(value, pixel.maximum, "channel", time=time) for value in (left[c], ~right[c])))
        for c in range(pixel.channels)
    ]
    return [
        Difference(
            replace(word[: pixel.bits], maximum=pixel.maximum),
            word[pixel.bits],
        )
        for word in add_fields(fields)
    ]


def _complement(a: Difference, b: Difference | None = None) -> Field:
    """The one's complement of ``a + b`` without the 1 that is missing from b; of ``a`` alone, in full."""
    other = b.complement() if b else replace(a.word, value=Const(a.word.maximum, len(a.word.value)))
    return Field(a.complement(), other, replace(a.sign, value=~a.sign.value))


def _add(a: Summand, b: Summand) -> Summand:
    """The sum of both: what is missing from one of them comes in as the carry."""
    if a.missing is None:
        a, b = b, a
    (word,) = add_fields([Field(a.word, b.word, a.missing)])
    return Summand(word, b.missing)
