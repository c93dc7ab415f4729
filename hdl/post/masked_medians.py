"""Two medians over pixels of similar colour: along the row, then down the column."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike
from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.memory.row_stack import RowStack
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.post.layout import is_measured, post_layout
from softdepth.hdl.post.rank import LowerMedian, median_latency
from softdepth.hdl.post.slots import PostSlots
from softdepth.hdl.post.stage import delayed, waiting


class MaskedMedians(wiring.Component):
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
        self._layout = post_layout(value_bits, colour_bits)
        super().__init__(
            {
                "i": In(stream.Signature(self._layout)),
                "o": Out(stream.Signature(post_layout(value_bits, 0))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rows, columns, spacing, clocks = self._rows, self._columns, self._spacing, self.clocks
        taps = columns // spacing  # on either side of the row's middle
        members = self._layout.members
        put = self._put()
        m.submodules.slots = slots = PostSlots(rows, columns, self._max_width, clocks)
        payload = self.i.payload
        m.d.comb += [
            slots.valid.eq(self.i.valid),
            self.i.ready.eq(slots.ready),
            *(getattr(slots, name).eq(payload[name]) for name in MARKERS),
        ]

        # What is compared: a colour and, if not all results count, whether this one does.
        compared = self._colour_bits + self._holes
        colour: Value = payload.colour
        if self._holes:
            colour = Cat(colour, is_measured(payload.code))
        kept_along = data.StructLayout({name: members[name] for name in ("code", "confidence")})

        # Clock 1: the pixel, compared with those before it in its row.
        slot = travelling(m, slots.slot, put - 1 if self._shared else 5 + clocks, "slot")
        pixel = delayed(m, Cat(payload.value, payload.code, payload.confidence), 1, "pixel")
        value, along = pixel[: self._value_bits], pixel[self._value_bits :]
        colours = [delayed(m, colour, 1, "colour")]
        for clock in range(1, 4 + clocks):
            colours.append(delayed(m, colours[-1], 1, f"late_{clock}"))
        before = delayed(m, slots.before, 1, "before")
        past = [Signal(compared, name=f"past_{k}", reset_less=True) for k in range(columns)]
        values = [
            Signal(self._value_bits, name=f"value_{k}", reset_less=True) for k in range(2 * columns + 1)
        ]
        likes = [Signal(taps, name=f"like_{k}", reset_less=True) for k in range(columns + 1)]
        passing = [Signal(kept_along, name=f"passing_{k}", reset_less=True) for k in range(columns + 1)]
        found = Cat(
            self._alike(colours[0], past[k]) & before[k] for k in range(spacing - 1, taps * spacing, spacing)
        )
        with m.If(slot[1]):
            m.d.sync += [
                Cat(*past).eq(Cat(colours[0], *past)),
                Cat(*values).eq(Cat(value, *values)),
                Cat(*likes).eq(Cat(found, *likes)),
                Cat(Value.cast(p) for p in passing).eq(Cat(along, *(Value.cast(p) for p in passing))),
            ]
        row_values = [values[columns + spacing * k] for k in range(-taps, taps + 1)]
        row_keep = self._kept([likes[columns + spacing * k] for k in range(-taps, 1)])

        # The same pixel, compared with those above it.
        m.submodules.colours = above = RowStack([(compared, rows)], self._max_width, clocks)
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

        # The row's median goes on top of its column, together with the pixel's answers.
        centre = Cat(values[columns], Value.cast(passing[columns]))
        centre = waiting(m, centre, put - 2, "centre")
        median_of_row = Signal(self._value_bits)
        middle = delayed(m, median_of_row, put - self._row_ready, "middle")
        if self._holes:
            passed = data.View(kept_along, centre[self._value_bits :])
            middle = Mux(is_measured(passed.code), middle, centre[: self._value_bits])
        tag = Cat(waiting(m, downs[columns], put - compares - 1, "tag"), centre[self._value_bits :])
        m.submodules.rows = stack = RowStack(
            [(self._value_bits, 2 * rows), (len(tag), rows)], self._max_width, clocks
        )
        looks_up = put - RowStack.ahead
        entering = travelling(m, slots.enters, looks_up, "enters")[-1]
        line_ends = delayed(m, slots.o_eol, looks_up, "line_ends")
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
        column_there = put + wait
        column_keep = self._kept([t[:rows] for t in tags])

        # A register before the column's median, because all tags are in one word.
        if self._shared:
            samples = max(len(row_values), len(column))
            none = Const(0, self._value_bits)  # a sample that is not kept, where the other median has more
            row, down_column = (
                Cat(*those, *[none] * (samples - len(those)), keep, Const(0, samples - len(those)))
                for those, keep in ((row_values, row_keep), (column, column_keep))
            )
            m.submodules.medians = last = LowerMedian(samples, self._value_bits)
            given = Signal(samples * (self._value_bits + 1), reset_less=True)
            m.d.sync += given.eq(Mux(slot[2], row, down_column))
            m.d.comb += median_of_row.eq(last.o)
        else:
            m.submodules.along_row = first = LowerMedian(len(row_values), self._value_bits)
            m.submodules.down_column = last = LowerMedian(len(column), self._value_bits)
            given = delayed(m, Cat(*column, column_keep), 1, "given")
            m.d.comb += [
                Cat(Value.cast(first.i), first.keep).eq(Cat(*row_values, row_keep)),
                median_of_row.eq(first.o),
            ]
        m.d.comb += Cat(Value.cast(last.i), last.keep).eq(given)

        latency = self._after_slot()
        layout = post_layout(self._value_bits, 0)
        m.submodules.queue = queue = ResultQueue(layout, -(-latency // clocks) + 1)
        rest = data.View(kept_along, waiting(m, tags[rows][rows:], latency - column_there, "rest"))
        result: Value = last.o
        if self._holes:
            result = Mux(
                is_measured(rest.code), result, waiting(m, column[rows], latency - column_there, "whole")
            )
        fresh = Signal(init=1)
        puts = travelling(m, slots.emits, latency, "emits")[-1]
        ends = delayed(m, Cat(slots.o_eof, slots.o_damaged), 1, "ends")
        markers = Cat(line_ends, waiting(m, ends, looks_up - 1, "ends"))
        eol, eof, damaged = waiting(m, markers, latency - looks_up, "markers")
        with m.If(puts):
            m.d.sync += fresh.eq(eof)
        m.d.comb += [
            # With a single median, one slot's row must not arrive together with another slot's column.
            slots.credit.eq(queue.credit & ~slot[-1] if self._shared else queue.credit),
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
        return m

    @property
    def latency(self) -> int:
        """Clocks from a line's last pixel to when the line's last result can be in the queue."""
        return self._columns * self.clocks + self._after_slot()

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
