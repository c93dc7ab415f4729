"""Decides when pixels enter two windows that lag behind them, and when their results leave."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.countdown import Countdown
from softdepth.hdl.memory.line_column import LineColumn
from softdepth.hdl.memory.pace import Pace
from softdepth.hdl.memory.window import MARKERS


class PostSlots(wiring.Component):
    """Goes through a frame pixel by pixel, then ``columns`` slots past each line and ``rows`` lines below.

    A slot is a clock in which a pixel of the frame, or one beyond it, enters. The pixel ``columns`` slots
    before it is then in the middle of its row, and the one ``rows`` rows above that in the middle of its
    column.

    Parameters
    ----------
    rows, columns : reach of the windows.
    max_width : pixels of the longest line.
    clocks : from a slot to the next, at least.

    Members
    -------
    valid, ready, sof, eol, eof, damaged : the pixels of sound frames.
    credit : a slot may begin.
    slot : a slot begins.
    stores, x : its pixel lies in one of the frame's columns; which one.
    before, above : which of the ``columns`` pixels before it, nearest first, lie in its line, and which of
        the ``rows`` above it lie in the frame. Above a pixel below the frame, none does.
    enters, o_eol : the middle of the row is a pixel of the frame or below it; it is its line's last.
    emits, o_eof, o_damaged : the middle of the column is a pixel of the frame; it is the frame's last; the
        frame was mended so far.
    """

    def __init__(self, rows: int, columns: int, max_width: int, clocks: int) -> None:
        self._rows, self._columns, self._max_width, self._clocks = rows, columns, max_width, clocks
        super().__init__(
            {
                "valid": In(1),
                "ready": Out(1),
                **{name: In(1) for name in MARKERS},
                "credit": In(1),
                "slot": Out(1),
                "stores": Out(1),
                "x": Out(range(max_width)),
                "before": Out(columns),
                "above": Out(rows),
                "enters": Out(1),
                "emits": Out(1),
                "o_eol": Out(1),
                "o_eof": Out(1),
                "o_damaged": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rows, columns = self._rows, self._columns
        below = Countdown(m, rows, "below")  # rows below the frame, this one included
        after = Countdown(m, columns, "after")  # slots behind the line
        column = LineColumn(m, self._max_width)
        beside = Signal(columns)  # a bit for each pixel of the line so far
        over = Signal(rows)  # and for each row of the frame
        damaged = Signal()
        flushing, trailing = below.some, after.some
        outside = Signal()
        pace = Pace(
            m,
            self._clocks,
            credit=self.credit,
            valid=self.valid,
            ready=self.ready,
            beyond=outside,
        )
        starts = Signal()
        last = Signal()
        now = Signal(rows)
        m.d.comb += [
            outside.eq(flushing | trailing),
            self.slot.eq(pace.slot),
            self.stores.eq(self.slot & ~trailing),
            starts.eq(~outside & self.sof),
            last.eq(Mux(outside, column.is_last, self.eol)),
            now.eq(Mux(starts, 0, over)),
            self.x.eq(column.x),
            self.before.eq(beside),
            self.above.eq(Mux(outside, 0, now)),
        ]
        with m.If(self.slot):
            with m.If(trailing):
                after.step()
            with m.Else():
                column.step(last)
                m.d.sync += [
                    beside.eq(Mux(last, 0, Cat(1, beside))),
                    over.eq(Mux(last, Cat(1, now), now)),
                ]
                with m.If(last):
                    after.start(columns)
                with m.If(~flushing):
                    m.d.sync += damaged.eq(self.damaged | (damaged & ~starts))
                    with m.If(self.eof):
                        below.start(rows)
                with m.Elif(last):
                    below.step()

        # What is known of each pixel, kept until it is in the middle of its row.
        enters = Signal(columns)
        emits = Signal(columns)
        eol = Signal(columns, reset_less=True)
        eof = Signal(columns, reset_less=True)
        with m.If(self.slot):
            m.d.sync += [
                enters.eq(Cat(~trailing, enters)),
                emits.eq(Cat(~trailing & now[-1], emits)),
                eol.eq(Cat(last, eol)),
                eof.eq(Cat(below.last & last, eof)),
            ]
        m.d.comb += [
            self.enters.eq(self.slot & enters[-1]),
            self.emits.eq(self.slot & emits[-1]),
            self.o_eol.eq(eol[-1]),
            self.o_eof.eq(eof[-1]),
            self.o_damaged.eq(damaged | (self.slot & ~outside & self.damaged)),
        ]
        return m
