"""Deals descriptors out as slots of steps, with what is needed beyond a line's and a frame's end."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.window import MARKERS


def slot_layout(payload: ShapeLike, columns: int, rows: int) -> data.StructLayout:
    """What is known of a slot.

    ``payload`` : of its pixel, if it has one.
    ``x`` : its column, counted on beyond the line's end.
    ``first_column`` : the line's first.
    ``inside`` : the column lies in the frame.
    ``rows`` : bit k says that the row k above this one lies in the frame.
    ``top`` : the row is the frame's first.
    ``emits``, and the markers : the slot completes the support of a pixel, ``columns`` to the left and
    ``rows`` up, and its markers.
    ``starts`` : that pixel is its line's first that is judged.
    """
    return data.StructLayout(
        {
            "payload": payload,
            "x": range(columns),
            "first_column": 1,
            "inside": 1,
            "rows": rows,
            "top": 1,
            "emits": 1,
            "starts": 1,
            **dict.fromkeys(MARKERS, 1),
        }
    )


class Slots(wiring.Component):
    """Issues slots of ``steps`` clocks: for each pixel, and where a support reaches beyond the frame.

    A line has ``right`` slots after its last pixel, a frame ``below`` lines after its last, and ``drain``
    slots after these, for what behind it counts in slots. The lines behind a frame come in like its own;
    for all else input is held back. Nothing waits for the frame that follows.

    Parameters
    ----------
    payload : of the raster that comes in, but for its markers.
    steps : clocks of a slot.
    right, below : columns and rows that supports reach to the right of a pixel and below it.
    history : rows above a slot's of which it is told whether they lie in the frame.
    first : the column of a line's first pixel that is judged.

    Members
    -------
    i : a raster: ``payload`` and the markers, and ``below`` lines behind each frame.
    credit : a slot may begin in this clock.
    begins : one does.
    valid, first, last, step : a step is taken; registered, one clock after ``begins``.
    slot : `slot_layout`, through all steps.
    """

    latency = 1

    def __init__(
        self,
        payload: ShapeLike,
        steps: int,
        max_width: int,
        *,
        right: int,
        below: int,
        history: int,
        drain: int,
        first: int = 0,
    ) -> None:
        self._first = first
        self._steps, self._right, self._below = steps, right, below
        self._history, self._drain, self._max_width = history, drain, max_width
        self.layout = slot_layout(payload, max_width + right, history + 1)
        members = {"payload": payload, **dict.fromkeys(MARKERS, 1)}
        super().__init__(
            {
                "i": In(stream.Signature(data.StructLayout(members))),
                "credit": In(1),
                "begins": Out(1),
                "valid": Out(1),
                "first": Out(1),
                "last": Out(1),
                "step": Out(range(steps)),
                "slot": Out(self.layout),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        item = self.i.payload
        x = Signal(range(self._max_width + self._right))
        beyond = Signal(range(self._right + 1))  # slots to the right of the frame still to come
        below = Signal(range(self._below + 1))  # lines below the frame still to come, this one included
        draining = Signal(range(self._drain + 1))
        age = Signal(range(self._below + 1))  # rows of the frame so far, up to the first that has a result
        ended = Signal()
        rows = Signal(self._history + 1)
        top = Signal()
        damaged = Signal()
        fresh = Signal()

        going = Signal()  # steps of this slot are left after this clock
        free = Signal()
        own, flushed, outside, drained = Signal(), Signal(), Signal(), Signal()
        m.d.comb += [
            free.eq(~going & self.credit),
            drained.eq(free & (draining != 0)),
            outside.eq(free & (draining == 0) & (beyond != 0)),
            self.i.ready.eq(free & (draining == 0) & (beyond == 0)),
            own.eq(self.i.valid & self.i.ready & (below == 0)),
            flushed.eq(self.i.valid & self.i.ready & (below != 0)),
            self.begins.eq(own | flushed | outside | drained),
        ]

        inside = Signal()
        at_end = Signal()  # the line's last pixel, or what stands for it below the frame
        over = Signal()  # the line's last slot
        starts = Signal()
        m.d.comb += [
            starts.eq(own & item.sof),
            inside.eq(own | flushed),
            at_end.eq(inside & item.eol),
            over.eq((at_end & (self._right == 0)) | (outside & (beyond == 1))),
        ]
        rows_now = Signal.like(rows)
        age_now = Signal.like(age)
        ended_now = Signal()
        m.d.comb += [
            rows_now.eq(Mux(starts, 1, rows)),
            age_now.eq(Mux(starts, 0, age)),
            ended_now.eq(Mux(own, item.eof, ended)),
        ]
        slot = Signal(self.layout, reset_less=True)
        emits = Signal()
        m.d.comb += emits.eq(~drained & (x >= self._right) & (age_now == self._below))
        final = Signal()
        m.d.comb += final.eq((below == 1) | (ended_now if self._below == 0 else 0))

        with m.If(self.begins):
            m.d.sync += [
                slot.payload.eq(item.payload),
                slot.x.eq(x),
                slot.first_column.eq((x == 0) & ~drained),
                slot.inside.eq(inside),
                slot.rows.eq(rows_now),
                slot.top.eq(starts | top),
                slot.emits.eq(emits),
                slot.starts.eq(emits & (x == self._right + self._first)),
                slot.sof.eq(emits & (fresh | starts)),
                slot.eol.eq(emits & over),
                slot.eof.eq(emits & over & final),
                slot.damaged.eq(Mux(own, item.damaged | (damaged & ~starts), damaged)),
                x.eq(Mux(over | drained, 0, x + 1)),
                fresh.eq((fresh | starts) & ~emits),
            ]
            with m.If(at_end):
                m.d.sync += beyond.eq(self._right)
            with m.If(outside):
                m.d.sync += beyond.eq(beyond - 1)
            with m.If(own):
                m.d.sync += [damaged.eq(item.damaged | (damaged & ~starts)), ended.eq(item.eof)]
            with m.If(starts):
                m.d.sync += [rows.eq(1), age.eq(0), top.eq(1)]
            with m.If(drained):
                m.d.sync += draining.eq(draining - 1)
            with m.If(over):
                m.d.sync += top.eq(0)
                with m.If(age_now != self._below):
                    m.d.sync += age.eq(age_now + 1)
                # What the row that follows knows of itself: below the frame it lies outside.
                more = Mux(below != 0, 0, ~ended_now)
                m.d.sync += rows.eq((rows_now << 1) | more)
                with m.If(below != 0):
                    m.d.sync += below.eq(below - 1)
                with m.Elif(ended_now):
                    m.d.sync += below.eq(self._below)
                with m.If(final):
                    m.d.sync += [draining.eq(self._drain), ended.eq(0)]

        step = Signal(range(self._steps))
        valid = Signal()
        m.d.comb += going.eq(valid & (step != self._steps - 1) if self._steps > 1 else 0)
        m.d.sync += valid.eq(self.begins | going)
        with m.If(self.begins):
            m.d.sync += step.eq(0)
        with m.Elif(going):
            m.d.sync += step.eq(step + 1)
        m.d.comb += [
            self.valid.eq(valid),
            self.step.eq(step),
            self.first.eq(valid & (step == 0)),
            self.last.eq(valid & (step == self._steps - 1)),
            self.slot.eq(slot),
        ]
        return m
