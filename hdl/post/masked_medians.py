"""Two medians over pixels of similar colour: along the row, then down the column."""

from collections.abc import Sequence
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike
from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.delay import delayed, waiting
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY, ResultQueue
from softdepth.hdl.memory.row_stack import RowStack
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.post.rank import LowerMedian, median_latency
from softdepth.hdl.post.slots import PostSlots
from softdepth.hdl.post.stage import PostStage, StageTime
from softdepth.hdl.winners.layout import is_measured, post_layout


@dataclass(frozen=True)
class Samples:
    """What a median is taken of, the newest first, and for each whether it counts."""

    values: list[Value]
    keep: Value


class MaskedMedians(PostStage):
    """Replaces each value by a lower median in its row, then by one in its column; the rest is unchanged.

    Of ``columns`` pixels on either side, or of every ``spacing``-th of them, and of ``rows`` above and below,
    those count that lie inside the frame and whose colour differs from the centre's by less than ``like`` in
    every channel; the centre always counts. With ``holes``, results without a measurement are left out and
    stay as they are.

    Two pixels are compared once, when the later one arrives, and the answer is kept for both. So only half of
    the comparisons are built, and the colours of the rows above are kept for only half of the window. A pixel
    outside the frame is like no other, so its colour and value do not matter and no edge is repeated. Both
    medians use the same slots: ``columns`` more per line and ``rows`` more lines per frame, in which the
    input is held back. One result every ``clocks`` clocks.

    Parameters
    ----------
    value_bits, colour_bits, channels : of a result; ``channels`` is how many equal parts its colour has.
    rows, columns, spacing : reach down the column and along the row, and which pixels of the row count.
    like : a number, or a signal that may change between frames.
    clocks : the fewest that a pixel takes, 1 or 2. With 2, the memory and its multiplexers are smaller.

    Members
    -------
    i : results, `post_layout`.
    o : results without their colours.
    """

    def __init__(
        self,
        value_bits: int,
        colour_bits: int,
        channels: int,
        max_width: int,
        *,
        rows: int,
        columns: int,
        spacing: int = 1,
        like: Value | int,
        holes: bool = False,
        clocks: int = 1,
    ) -> None:
        self._value_bits, self._colour_bits, self._channels = value_bits, colour_bits, channels
        self._rows, self._columns, self._spacing = rows, columns, spacing
        self._max_width, self._like = max_width, like
        self._holes, self.clocks = holes, clocks
        layout = post_layout(value_bits, colour_bits)
        self._passing = data.StructLayout({name: layout.members[name] for name in ("code", "confidence")})
        super().__init__(
            {
                "i": In(stream.Signature(layout)),
                "o": Out(stream.Signature(post_layout(value_bits, 0))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.slots = slots = PostSlots(self._rows, self._columns, self._max_width, self.clocks)
        m.d.comb += [
            slots.valid.eq(self.i.valid),
            self.i.ready.eq(slots.ready),
            *(getattr(slots, name).eq(self.i.payload[name]) for name in MARKERS),
        ]
        slot = travelling(m, slots.slot, self._put() - 1 if self._shared else 5 + self.clocks, "slot")
        # Clock 1: the pixel, and what is compared: a colour and, if not all results count, whether this does.
        payload = self.i.payload
        colour = Cat(payload.colour, is_measured(payload.code)) if self._holes else payload.colour
        pixel = delayed(m, Cat(payload.value, payload.code, payload.confidence), 1, "pixel")
        colours = [delayed(m, colour, 1, "colour")]
        for clock in range(1, 4 + self.clocks):
            colours.append(delayed(m, colours[-1], 1, f"late_{clock}"))

        row, passing = self._along_row(m, slots, slot[1], pixel, colours[0])
        answers = self._compared_above(m, slots, slot, colours)
        median_of_row = Signal(self._value_bits)
        column, rest, line_ends = self._down_column(m, slots, row, median_of_row, answers, passing)
        median = self._medians(m, slot[2], row, column, median_of_row)
        queue = self._results(m, slots, median, column, rest, line_ends)
        # With a single median, one slot's row must not arrive together with another slot's column.
        m.d.comb += slots.credit.eq(queue.credit & ~slot[-1] if self._shared else queue.credit)
        return m

    def _along_row(
        self, m: Module, slots: PostSlots, slot: Value, pixel: Value, colour: Value
    ) -> tuple[Samples, Value]:
        """Compares the pixel with those before it in its row.

        Gives the samples of the row's median, and what stays with the pixel in their middle.
        """
        columns, spacing = self._columns, self._spacing
        taps = columns // spacing  # on either side of the row's middle
        value, along = pixel[: self._value_bits], pixel[self._value_bits :]
        before = delayed(m, slots.before, 1, "before")
        past = [Signal(len(colour), name=f"past_{k}", reset_less=True) for k in range(columns)]
        values = [
            Signal(self._value_bits, name=f"value_{k}", reset_less=True) for k in range(2 * columns + 1)
        ]
        likes = [Signal(taps, name=f"like_{k}", reset_less=True) for k in range(columns + 1)]
        passing = [Signal(self._passing, name=f"passing_{k}", reset_less=True) for k in range(columns + 1)]
        found = Cat(
            self._alike(colour, past[k]) & before[k] for k in range(spacing - 1, taps * spacing, spacing)
        )
        with m.If(slot):
            m.d.sync += [
                Cat(*past).eq(Cat(colour, *past)),
                Cat(*values).eq(Cat(value, *values)),
                Cat(*likes).eq(Cat(found, *likes)),
                Cat(Value.cast(p) for p in passing).eq(Cat(along, *(Value.cast(p) for p in passing))),
            ]
        row_values = [values[columns + spacing * k] for k in range(-taps, taps + 1)]
        keep = self._kept([likes[columns + spacing * k] for k in range(-taps, 1)])
        return Samples(row_values, keep), Value.cast(passing[columns])

    def _compared_above(
        self, m: Module, slots: PostSlots, slot: Sequence[Value], colours: Sequence[Value]
    ) -> Value:
        """Compares the pixel with those above it; gives the answers when it is in the middle of its row."""
        rows, columns = self._rows, self._columns
        m.submodules.colours = above = RowStack([(len(colours[0]), rows)], self._max_width, self.clocks)
        m.d.comb += [
            above.valid.eq(travelling(m, slots.stores, 1, "stores")[-1]),
            above.place.eq(delayed(m, slots.x, 1, "x")),
            above.items["0"].eq(colours[above.ahead]),
        ]
        compares = 1 + above.latency
        over = delayed(m, slots.above, compares, "above")
        down = Cat(self._alike(colours[above.latency], above.o["0"][k]) & over[k] for k in range(rows))
        downs = [Signal(rows, name=f"down_{k}", reset_less=True) for k in range(columns + 1)]
        with m.If(slot[compares]):
            m.d.sync += Cat(*downs).eq(Cat(down, *downs))
        return waiting(m, downs[columns], self._put() - compares - 1, "tag")

    def _down_column(
        self, m: Module, slots: PostSlots, row: Samples, median: Value, answers: Value, passing: Value
    ) -> tuple[Samples, Value, Value]:
        """The row's median goes on top of its column, together with the pixel's answers.

        Gives the samples of the column's median, what stayed with the one in their middle, and whether
        the column is its line's last, `_looks_up` clocks after its slot.
        """
        rows, put = self._rows, self._put()
        centre = waiting(m, Cat(row.values[len(row.values) // 2], passing), put - 2, "centre")
        middle = delayed(m, median, put - self._row_ready, "middle")
        if self._holes:
            passed = data.View(self._passing, centre[self._value_bits :])
            middle = Mux(is_measured(passed.code), middle, centre[: self._value_bits])
        tag = Cat(answers, centre[self._value_bits :])
        m.submodules.rows = stack = RowStack(
            [(self._value_bits, 2 * rows), (len(tag), rows)], self._max_width, self.clocks
        )
        entering = travelling(m, slots.enters, self._looks_up, "enters")[-1]
        line_ends = delayed(m, slots.o_eol, self._looks_up, "line_ends")
        at = Signal(range(self._max_width))
        with m.If(entering):
            m.d.sync += at.eq(Mux(line_ends, 0, at + 1))
        m.d.comb += [
            stack.valid.eq(entering),
            stack.place.eq(at),
            stack.items["0"].eq(middle),
            stack.items["1"].eq(tag),
        ]
        wait = stack.latency - RowStack.ahead
        column = [delayed(m, middle, wait, "newest"), *stack.o["0"]]
        tags = [delayed(m, tag, wait, "newest_tag"), *stack.o["1"]]
        return Samples(column, self._kept([t[:rows] for t in tags])), tags[rows][rows:], line_ends

    def _medians(
        self, m: Module, slot: Value, row: Samples, column: Samples, median_of_row: Signal
    ) -> LowerMedian:
        """Gives the block that finds the column's median, behind a register: all tags come in one word."""
        if self._shared:
            samples = max(len(row.values), len(column.values))
            none = Const(0, self._value_bits)  # a sample that is not kept, where the other median has more
            padded = [
                Cat(*s.values, *[none] * (samples - len(s.values)), s.keep, Const(0, samples - len(s.values)))
                for s in (row, column)
            ]
            m.submodules.medians = last = LowerMedian(samples, self._value_bits)
            given = Signal(samples * (self._value_bits + 1), reset_less=True)
            m.d.sync += given.eq(Mux(slot, *padded))
            m.d.comb += median_of_row.eq(last.o)
        else:
            m.submodules.along_row = first = LowerMedian(len(row.values), self._value_bits)
            m.submodules.down_column = last = LowerMedian(len(column.values), self._value_bits)
            given = delayed(m, Cat(*column.values, column.keep), 1, "given")
            m.d.comb += [
                Cat(Value.cast(first.i), first.keep).eq(Cat(*row.values, row.keep)),
                median_of_row.eq(first.o),
            ]
        m.d.comb += Cat(Value.cast(last.i), last.keep).eq(given)
        return last

    def _results(
        self, m: Module, slots: PostSlots, median: LowerMedian, column: Samples, rest: Value, line_ends: Value
    ) -> ResultQueue:
        """The queue in which results end, with their markers."""
        latency = self._after_slot()
        layout = post_layout(self._value_bits, 0)
        m.submodules.queue = queue = ResultQueue(layout, -(-latency // self.clocks) + 1)
        computed = median.latency + 1
        rest = data.View(self._passing, waiting(m, rest, computed, "rest"))
        result: Value = median.o
        if self._holes:
            whole = waiting(m, column.values[self._rows], computed, "whole")
            result = Mux(is_measured(rest.code), result, whole)
        fresh = Signal(init=1)
        puts = travelling(m, slots.emits, latency, "emits")[-1]
        ends = delayed(m, Cat(slots.o_eof, slots.o_damaged), 1, "ends")
        markers = Cat(line_ends, waiting(m, ends, self._looks_up - 1, "ends"))
        eol, eof, damaged = waiting(m, markers, latency - self._looks_up, "markers")
        with m.If(puts):
            m.d.sync += fresh.eq(eof)
        m.d.comb += [
            queue.promised.eq(slots.emits),
            queue.put.eq(puts),
            queue.result.value.eq(result),
            queue.result.code.eq(rest.code),
            queue.result.confidence.eq(rest.confidence),
            queue.result.sof.eq(fresh),
            queue.result.eol.eq(eol),
            queue.result.eof.eq(eof),
            queue.result.damaged.eq(damaged),
        ]
        wiring.connect(m, queue.o, wiring.flipped(self.o))
        return queue

    @property
    def time(self) -> StageTime:
        behind = self._columns * self.clocks + self._after_slot() + QUEUE_LATENCY
        return StageTime(behind, self._rows, self._columns, self.clocks)

    @property
    def _shared(self) -> bool:
        """One median does both the rows and the columns."""
        return self.clocks == 2

    @property
    def _row_ready(self) -> int:
        """Clocks from a slot to its row's median."""
        return 2 + self._shared + median_latency(self._value_bits)

    def _put(self) -> int:
        """Clocks from a slot to when its row's median goes on top of its column.

        An even number where a median is shared: rows of slots follow each other every other clock, and the
        column then comes between two of them.
        """
        put = max(self._row_ready, 2 + RowStack.ahead + self.clocks - 1)
        return put + put % 2 if self._shared else put

    @property
    def _looks_up(self) -> int:
        """Clocks from a slot to when its column is looked up."""
        return self._put() - RowStack.ahead

    def _after_slot(self) -> int:
        return self._put() + (self.clocks - 1) + 1 + median_latency(self._value_bits)

    def _alike(self, a: Value, b: Value) -> Value:
        bits = self._colour_bits
        like = alike(a[:bits], b[:bits], self._channels, self._like)
        return like & a[bits] & b[bits] if self._holes else like

    def _kept(self, likes: list[Value]) -> Value:
        """Which of the samples, newest first, are like the one in the middle.

        ``likes`` are the answers of the samples up to the middle, each about those before it.
        """
        reach = len(likes) - 1
        newer = [likes[k][reach - 1 - k] for k in range(reach)]
        return Cat(*newer, 1, likes[reach])
