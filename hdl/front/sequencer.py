"""Deals pixels out as steps, and says which result leaves with which."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.frame_guard import item_layout
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def tags_layout() -> data.StructLayout:
    """What is known of a result before it is computed: its code, markers and damage."""
    return data.StructLayout({"code": 2, "sof": 1, "eol": 1, "eof": 1, "damaged": 1})


class Sequencer(wiring.Component):
    """Takes items from the frame guard and issues ``steps`` steps a pixel, without a pause.

    Results leave in raster order, one with each pixel: the result of (x, y) leaves with the pixel
    at (x + reach_right, y + reach_rows), where its support is complete. The last results of a
    frame have no such pixel. They are border results, need no data, and leave with the first
    pixels of the next frame, or by themselves in clocks without a pixel (the frame is *drained*).

    Members
    -------
    i : items of well-formed frames.
    credit : in the next clock there is room for another result at the far end of the pipeline.
    load : the pixel in ``i`` begins; its ``x`` and colours are valid in this clock only.
    valid, first, last, step : a step is taken; registered, one clock after ``load``.
    first_of_line : the step's pixel is its line's first.
    first_inner : the step's pixel is its line's first whose support lies inside the image.
    emit, tags : a result leaves with this clock (a pixel's last step, or a drain), and its tags.
    issued : a result was promised in this clock: a credit is used.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "i": In(stream.Signature(item_layout(config))),
                "credit": In(1),
                "load": Out(1),
                "valid": Out(1),
                "first": Out(1),
                "last": Out(1),
                "step": Out(range(config.steps)),
                "first_of_line": Out(1),
                "first_inner": Out(1),
                "emit": Out(1),
                "tags": Out(tags_layout()),
                "issued": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        item = self.i.payload

        # The frame that comes in.
        support_y = 2 * config.reach_rows
        y = Signal(range(support_y + 1))  # stops counting at the first row with inner pixels
        room = Signal(range(config.disparities))  # stops counting at the last candidate
        width = Signal(range(config.max_width))  # last column of the line before
        width_less_1 = Signal.like(width)
        row = Signal.like(y)
        # Both rows lie below a frame's first, whose first pixel says of itself that it completes nothing.
        on_first_row = Signal()  # `row` is the first that completes a result's support, and none did yet
        on_inner_rows = Signal()  # and the first that completes one inside the image
        m.d.comb += row.eq(Mux(item.sof, 0, y))

        # The frame whose results go out: this one once `started`, the one before while `draining`.
        started = Signal()
        draining = Signal()
        fresh = Signal()
        out_left = Signal(range(config.max_width))  # results to come on its line after the next
        out_last = Signal()  # none
        out_width = Signal(range(config.max_width), reset_less=True)
        rows_left = Signal(range(config.reach_rows + 1), reset_less=True)
        drain_damaged = Signal(reset_less=True)

        starts = Signal()
        own = Signal()
        ends = Signal()
        m.d.comb += [
            starts.eq(on_first_row & item.completes),
            own.eq(started | starts),
            ends.eq(item.eof | item.end),
        ]

        # What happens in this clock.
        busy = Signal()  # a pixel's step follows, known a clock before
        held = Signal()  # so is this: that, or no credit
        emits = Signal()
        drains = Signal()
        m.d.comb += [
            emits.eq(own | draining),
            # Whether or not a result leaves with the pixel: the queue waits for this, so that little decides.
            self.i.ready.eq(~held & ~(draining & (starts | ends))),
            self.load.eq(self.i.valid & self.i.ready & ~item.end),
            drains.eq(draining & ~held & ~self.load),
            self.issued.eq(drains | (self.load & emits)),
        ]

        inner = Signal()
        first_out = Signal()
        begins = Signal()  # `starts`, and the frame before is out of the way
        m.d.comb += [
            begins.eq(starts & ~draining),
            inner.eq(own & on_inner_rows & item.inner),
            first_out.eq(fresh | begins),
        ]
        room_now = Signal.like(room)
        m.d.comb += room_now.eq(Mux(item.first_inner, 0, room))
        tags = Signal(tags_layout(), reset_less=True)
        emit = Signal()
        drain = Signal()
        at_eol = Signal()
        m.d.comb += at_eol.eq(out_last & ~begins)  # lines have more than one pixel

        with m.If(self.issued):
            inner_code = Mux(room_now == config.disparities - 1, Validity.FULL, Validity.PARTIAL)
            m.d.sync += [
                tags.code.eq(Mux(draining | ~inner, Validity.BORDER, inner_code)),
                tags.sof.eq(first_out),
                tags.eol.eq(at_eol),
                tags.eof.eq(draining & at_eol & (rows_left == 0)),
                tags.damaged.eq(Mux(draining, drain_damaged, item.damaged)),
                fresh.eq(0),
                out_left.eq(Mux(begins, width_less_1, out_left - 1)),
                out_last.eq((out_left == 1) & ~begins),
            ]
            with m.If(at_eol):
                m.d.sync += [out_left.eq(out_width), out_last.eq(0)]
            with m.If(begins):
                m.d.sync += out_width.eq(width)
            with m.If(draining & at_eol):
                m.d.sync += rows_left.eq(rows_left - 1)
                with m.If(rows_left == 0):
                    m.d.sync += draining.eq(0)

        with m.If(self.load):
            m.d.sync += [
                self.first_of_line.eq(item.first),
                self.first_inner.eq(item.first_inner),
                emit.eq(emits),
            ]
            with m.If(item.inner & (room_now != config.disparities - 1)):
                m.d.sync += room.eq(room_now + 1)
            with m.If(starts):
                m.d.sync += [started.eq(1), on_first_row.eq(0)]
            with m.If(item.sof):
                m.d.sync += [y.eq(0), on_first_row.eq(0), on_inner_rows.eq(0)]
            with m.If(item.eol):
                m.d.sync += [width.eq(item.x), width_less_1.eq(item.x - 1)]
                with m.If(row != support_y):
                    m.d.sync += [
                        y.eq(row + 1),
                        on_first_row.eq(row == config.reach_rows - 1),
                        on_inner_rows.eq(row == support_y - 1),
                    ]

        with m.If(self.i.valid & self.i.ready & ends):
            rows = Signal(range(support_y + 2))
            m.d.comb += rows.eq(row + item.eof)  # an end item comes after its last row was counted
            m.d.sync += [
                draining.eq(1),
                started.eq(0),
                y.eq(0),
                on_first_row.eq(0),
                on_inner_rows.eq(0),
                drain_damaged.eq(item.damaged),
            ]
            with m.If(own):
                # The row in progress ends inside the frame, unless nothing reaches to the right.
                m.d.sync += rows_left.eq(config.reach_rows - (config.reach_right == 0))
            with m.Else():
                m.d.sync += [
                    rows_left.eq(rows - 1),
                    fresh.eq(1),
                    out_left.eq(Mux(item.end, width, item.x)),
                    out_last.eq(0),
                    out_width.eq(Mux(item.end, width, item.x)),
                ]

        more = Signal()
        m.d.comb += more.eq(Mux(busy, self.step != config.steps - 2, self.load & (config.steps > 1)))
        m.d.sync += [
            self.valid.eq(self.load | busy),
            busy.eq(more),
            held.eq(more | ~self.credit),
            drain.eq(drains),
        ]
        with m.If(busy):
            m.d.sync += self.step.eq(self.step + 1)
        with m.Else():
            m.d.sync += self.step.eq(0)
        m.d.comb += [
            self.first.eq(self.step == 0),
            self.last.eq(self.step == config.steps - 1),
            self.emit.eq(drain | (self.valid & ~busy & emit)),
            self.tags.eq(tags),
        ]
        return m
