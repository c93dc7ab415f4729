"""Turns pixels into steps, and decides which result leaves with which step."""

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.frame_guard import item_layout
from softdepth.hdl.front.step_counter import StepCounter
from softdepth.hdl.front.support_rows import SupportRows
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def tags_layout() -> data.StructLayout:
    """What is known of a result before it is computed: its code, markers and damage."""
    return data.StructLayout({"code": 2, "sof": 1, "eol": 1, "eof": 1, "damaged": 1})


class Leaving(enum.Enum, shape=2):  # type: ignore[call-arg]  # the shape is for amaranth.lib.enum
    """Whose results leave. The states with results have a bit each, because timing is tight on both.

    ``WAIT``: none, because the frame's first support is not complete. ``OWN``: one result of the frame with
    each of its pixels. ``DRAIN``: the remaining results of the frame before. The next frame may begin
    meanwhile, but it waits before its own results would leave, and before it ends.
    """

    WAIT = 0b00
    OWN = 0b01
    DRAIN = 0b10


class Sequencer(wiring.Component):
    """Takes items from the frame guard and issues ``steps`` steps per pixel, without a pause.

    Results leave in raster order, one with each pixel: the result of (x, y) leaves with the pixel
    at (x + reach_right, y + reach_rows), which completes its support. For the last results of a
    frame there is no such pixel. They are border results, need no data, and leave with the first
    pixels of the next frame, or on their own in clocks without a pixel.

    Members
    -------
    i : items of well-formed frames.
    credit : in the next clock there is room for another result at the far end of the pipeline.
    load : the pixel in ``i`` begins; its ``x`` and colours are valid only in this clock.
    valid, first, last, step : a step is taken; registered, one clock after ``load``.
    first_of_line : the step's pixel is the first of its line.
    first_inner : the step's pixel is the first of its line whose support lies inside the image.
    emit, tags : a result leaves in this clock (a pixel's last step, or a drain), and its tags.
    issued : a result is promised in this clock, which uses up a credit.
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
        m.submodules.steps = steps = StepCounter(config.steps)
        m.submodules.rows = rows = SupportRows(config.reach_rows)

        # What happens in this clock.
        taken = Signal()
        starts = Signal()  # the item completes the support of the frame's first result
        ends = Signal()  # the item ends the frame
        draining = Signal()  # results that leave are those of the frame before
        own = Signal()  # they are those of this one
        drains = Signal()  # a result leaves on its own
        m.d.comb += [
            starts.eq(rows.first & item.completes),
            ends.eq(item.eof | item.end),
            # This needs a credit even if no result leaves, which keeps the path of `ready` short.
            self.i.ready.eq(~steps.held & ~(draining & (starts | ends))),
            taken.eq(self.i.valid & self.i.ready),
            self.load.eq(taken & ~item.end),
            drains.eq(draining & ~steps.held & ~self.load),
            self.issued.eq(drains | (self.load & (own | draining))),
            rows.line_ends.eq(self.load & item.eol),
            rows.frame_ends.eq(taken & ends),
        ]

        line_over = Signal()  # the result that leaves is the last of its line
        frame_over = Signal()  # ... and of its frame
        state = Signal(Leaving)
        running = Signal()  # results of this frame left with the pixel before, too
        m.d.comb += [
            running.eq(Value.cast(state)[0]),
            draining.eq(Value.cast(state)[1]),
            own.eq(running | (starts & ~draining)),
        ]
        with m.Switch(state):
            with m.Case(Leaving.WAIT):
                with m.If(taken & starts):
                    m.d.sync += state.eq(Leaving.OWN)
                with m.If(taken & ends):
                    m.d.sync += state.eq(Leaving.DRAIN)
            with m.Case(Leaving.OWN), m.If(taken & ends):
                m.d.sync += state.eq(Leaving.DRAIN)
            with m.Case(Leaving.DRAIN), m.If(self.issued & frame_over):
                m.d.sync += state.eq(Leaving.WAIT)

        # Where in their frame the results that leave are.
        width = Signal(range(config.max_width))  # of the frame that comes in: its last column
        width_less_1 = Signal.like(width)
        left = Signal.like(width)  # results of the line that come after the next one
        none_left = Signal()
        line_width = Signal.like(width, reset_less=True)  # of the frame that goes out
        lines_left = Signal(range(config.reach_rows + 1), reset_less=True)  # after this one
        fresh = Signal()  # a frame has ended before any of its results left: its first one is next
        drain_damaged = Signal(reset_less=True)
        begins = Signal()  # the frame's first result leaves with this pixel
        m.d.comb += [
            begins.eq(starts & ~draining),
            line_over.eq(none_left & ~begins),  # lines have more than one pixel
            frame_over.eq(draining & line_over & (lines_left == 0)),
        ]
        with m.If(self.issued):
            m.d.sync += [
                fresh.eq(0),
                left.eq(Mux(begins, width_less_1, left - 1)),
                none_left.eq((left == 1) & ~begins),
            ]
            with m.If(line_over):
                m.d.sync += [left.eq(line_width), none_left.eq(0)]
            with m.If(draining & line_over):
                m.d.sync += lines_left.eq(lines_left - 1)
        # One clock later is early enough: lines are longer than that, and those of a frame equally wide.
        begun = Signal()
        m.d.sync += begun.eq(self.load & begins)
        with m.If(begun):
            m.d.sync += line_width.eq(width)
        with m.If(self.load & item.eol):
            m.d.sync += [width.eq(item.x), width_less_1.eq(item.x - 1)]
        with m.If(taken & ends):
            m.d.sync += drain_damaged.eq(item.damaged)
            with m.If(own):
                # The row in progress ends inside the frame, unless nothing reaches to the right.
                m.d.sync += lines_left.eq(config.reach_rows - (config.reach_right == 0))
            with m.Else():
                last_column = Mux(item.end, width, item.x)
                m.d.sync += [
                    lines_left.eq(rows.rows - item.end),  # an end item comes after its last row was counted
                    fresh.eq(1),
                    left.eq(last_column),
                    none_left.eq(0),
                    line_width.eq(last_column),
                ]

        # How many candidates besides the first have their partner in the image, at most all of them.
        room = Signal(range(config.disparities))
        room_now = Signal.like(room)
        m.d.comb += room_now.eq(Mux(item.first_inner, 0, room))
        with m.If(self.load & item.inner & (room_now != config.disparities - 1)):
            m.d.sync += room.eq(room_now + 1)

        inner = Signal()
        tags = Signal(tags_layout(), reset_less=True)
        m.d.comb += inner.eq(running & rows.inner & item.inner)  # no frame's results start so late
        with m.If(self.issued):
            inner_code = Mux(room_now == config.disparities - 1, Validity.FULL, Validity.PARTIAL)
            m.d.sync += [
                tags.code.eq(Mux(inner, inner_code, Validity.BORDER)),
                tags.sof.eq(fresh | begins),
                tags.eol.eq(line_over),
                tags.eof.eq(frame_over),
                tags.damaged.eq(Mux(draining, drain_damaged, item.damaged)),
            ]

        drained = Signal()
        emits = Signal()  # a result leaves with the pixel's last step
        m.d.sync += drained.eq(drains)
        with m.If(self.load):
            m.d.sync += [
                self.first_of_line.eq(item.first),
                self.first_inner.eq(item.first_inner),
                emits.eq(own | draining),
            ]
        m.d.comb += [
            steps.load.eq(self.load),
            steps.credit.eq(self.credit),
            *[getattr(self, name).eq(getattr(steps, name)) for name in ("valid", "first", "last", "step")],
            self.emit.eq(drained | (steps.last & emits)),
            self.tags.eq(tags),
        ]
        return m
