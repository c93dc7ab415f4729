"""Goes through a raster in the slots that windows need: each column, and repeats beyond an edge."""

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import stream

from softdepth.hdl.arithmetic.countdown import Countdown
from softdepth.hdl.memory.line_column import LineColumn
from softdepth.hdl.memory.pace import Pace


class WindowSlots:
    """Says what enters a window in each slot, and which slot completes one.

    A slot begins when a column enters: a new one, or the previous one again. A line's first and last columns
    enter ``columns`` more times, and ``rows + after`` lines follow a frame's last. In all of these extra
    slots, input is held back.

    Parameters
    ----------
    m : the module that this is part of.
    i : a raster, of sound frames; its ``ready`` is driven.
    credit : a register that says whether a window may be begun.
    rows, columns : reach of the window below its centre, and to either side.
    after : lines after the last that has results.
    max_width : pixels of the longest line.
    clocks : the fewest that a slot takes.

    Members
    -------
    slot : there is one; the members below mean something only then.
    new : its column has not entered before.
    own : it takes a pixel of the frame; ``starts``: the frame's first.
    below : counts the lines behind the frame, including this one.
    top : the column is of the frame's first row.
    inside : its column is the last copy of a line's first, or the first copy of its last.
    x : the column's place in the line.
    emits : it completes a window; ``sof``, ``eof``: that of the frame's first pixel, or its last.
    line_over : it is its line's last.
    ended : in such a slot: the frame's last pixel was taken.
    damage : the frame was mended somewhere up to the pixel before; ``damaged``, or this one.
    """

    def __init__(
        self,
        m: Module,
        i: stream.Interface,
        credit: Value,
        *,
        rows: int,
        columns: int,
        after: int = 0,
        max_width: int,
        clocks: int,
    ) -> None:
        item = i.payload
        at_line_start = Signal(init=1)
        column_at = LineColumn(m, max_width)
        self.x = column_at.x
        self.below = below = Countdown(m, rows + after, "below")
        repeats = Countdown(m, columns, "repeats")
        # Columns still to come before a whole window, and rows before the first with a result. As frames are
        # whole, both are set at the end of the line or frame before.
        unfilled = Countdown(m, 2 * columns, "unfilled", init=2 * columns)
        unripe = Countdown(m, rows, "unripe", init=rows)
        after_last = Signal()  # the repeats are of the line's last column
        in_first_row = Signal()
        fresh = Signal()  # no result of the frame has left
        took_last = Signal()  # the frame's last pixel was taken
        self.damage = Signal()

        beyond = repeats.some | below.some
        self.slot = Pace(m, clocks, credit=credit, valid=i.valid, ready=i.ready, beyond=beyond).slot
        self.new, self.own, self.starts = Signal(name="new"), Signal(name="own"), Signal(name="starts")
        self.line_over, self.emits = Signal(name="line_over"), Signal(name="emits")
        first, last, final = Signal(name="first"), Signal(name="last"), Signal(name="final")
        # Lines end with their last repeat, if they have any, and `ended` is not looked at before that.
        self.ended = took_last if columns else Mux(self.own, item.eof, took_last)
        damage_now = item.damaged | (self.damage & ~self.starts)
        self.damaged = Mux(self.own, damage_now, self.damage)
        m.d.comb += [
            self.new.eq(~repeats.some),
            self.own.eq(self.new & ~below.some),
            first.eq(self.new & at_line_start),
            last.eq(self.new & Mux(below.some, column_at.is_last, item.eol)),
            self.starts.eq(self.own & item.sof),
            self.line_over.eq(repeats.last & after_last if columns else last),
            self.emits.eq(~unripe.some & ~unfilled.some),
            final.eq(below.last if rows + after else self.ended),
        ]
        self.top = self.starts | in_first_row
        self.inside = Mux(self.new, ~first | (columns == 0), repeats.last & ~after_last)
        self.sof = fresh | (self.starts & (rows == 0))
        self.eof = self.line_over & (below.left == after + 1 if after else final)

        with m.If(self.slot):
            with m.If(unfilled.some):
                unfilled.step()
            with m.If(self.new):
                m.d.sync += [at_line_start.eq(last), after_last.eq(last)]
                column_at.step(last)
                with m.If(first | last):
                    repeats.start(columns)
            with m.Else():
                repeats.step()
            with m.If(self.starts):
                m.d.sync += [in_first_row.eq(1), fresh.eq(1)]
            with m.If(self.own):
                m.d.sync += [self.damage.eq(damage_now), took_last.eq(item.eof)]
            with m.If(self.line_over):
                m.d.sync += in_first_row.eq(0)
                unfilled.start(2 * columns)
                with m.If(unripe.some):
                    unripe.step()
                with m.If(below.some):
                    below.step()
                with m.Elif(self.ended):
                    below.start(rows + after)
                with m.If(final):
                    unripe.start(rows)
            with m.If(self.emits):
                m.d.sync += fresh.eq(0)
