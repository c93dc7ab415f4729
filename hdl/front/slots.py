"""Hands descriptors out in slots of steps, with those needed beyond the ends of lines and frames."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.countdown import Countdown
from softdepth.hdl.memory.pace import Pace
from softdepth.hdl.memory.window import MARKERS


def slot_layout(payload: ShapeLike, columns: int, rows: int) -> data.StructLayout:
    """What is known about a slot.

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

    A line has ``right`` slots after its last pixel. A frame has ``below`` lines after its last, and ``drain``
    slots after these, for blocks further on that count in slots. The lines after a frame come in like its
    own; for all other slots, input is held back. Nothing waits for the next frame.

    Parameters
    ----------
    payload : of the raster that comes in, without its markers.
    steps : clocks of a slot.
    right, below : columns and rows that supports reach to the right of a pixel and below it.
    history : how many rows above a slot's own tell whether they lie in the frame.
    first : the column of the first pixel of a line that is judged.

    Members
    -------
    i : a raster: ``payload`` and the markers, and ``below`` lines behind each frame.
    credit : a slot may begin in this clock.
    begins : one does.
    valid, first, last, step : a step is taken; registered, one clock after ``begins``.
    slot : `slot_layout`, through all steps; of no meaning without one.
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
        beyond = Countdown(m, self._right, "beyond")  # slots to the right of the frame
        below = Countdown(m, self._below, "below")  # lines below the frame, this one included
        draining = Countdown(m, self._drain, "draining")
        # Rows of the frame up to the first that has a result. Frames are whole: it is set at the end of one.
        unripe = Countdown(m, self._below, "unripe", init=self._below)
        x = Signal(range(self._max_width + self._right))
        # Of ``x``: the line's first, from the first pixel that is judged on, and the first that counts.
        at_first, judging, at_start = (
            Signal(name=name, init=at == 0)
            for name, at in (
                ("at_first", 0),
                ("judging", self._right),
                ("at_start", self._right + self._first),
            )
        )
        ended = Signal()
        rows = Signal(self._history + 1)
        top = Signal()
        damaged = Signal()
        fresh = Signal()

        pace = Pace(
            m,
            self._steps,
            credit=self.credit,
            valid=self.i.valid,
            ready=self.i.ready,
            beyond=draining.some | beyond.some,
        )
        # Steps of this slot are left after this clock, and one.
        going, ending = pace.rest.some, pace.rest.last
        m.d.comb += self.begins.eq(pace.slot)

        # What a slot is if one begins.
        own = Signal()  # of a pixel of the frame
        inside = Signal()  # the same, or below it
        at_end = Signal()  # the line's last pixel, or what stands for it below the frame
        over = Signal()  # the line's last slot
        starts = Signal()
        m.d.comb += [
            inside.eq(~draining.some & ~beyond.some),
            own.eq(inside & ~below.some),
            starts.eq(own & item.sof),
            at_end.eq(inside & item.eol),
            over.eq(beyond.last if self._right else at_end),
        ]
        rows_now = Signal.like(rows)
        ended_now = Signal()
        emits = Signal()
        final = Signal()
        m.d.comb += [
            rows_now.eq(Mux(starts, 1, rows)),
            ended_now.eq(Mux(own, item.eof, ended)),
            emits.eq(~draining.some & judging & ~unripe.some),
            final.eq(below.last | (ended_now if self._below == 0 else 0)),
        ]

        # An idle slot takes whatever is offered: so a register alone decides over its many bits.
        slot = Signal(self.layout, reset_less=True)
        with m.If(~going):
            m.d.sync += [
                slot.payload.eq(item.payload),
                slot.x.eq(x),
                slot.first_column.eq(at_first & ~draining.some),
                slot.inside.eq(inside),
                slot.rows.eq(rows_now),
                slot.top.eq(starts | top),
                slot.emits.eq(emits),
                slot.starts.eq(emits & at_start),
                slot.sof.eq(emits & (fresh | starts)),
                slot.eol.eq(emits & over),
                slot.eof.eq(emits & over & final),
                slot.damaged.eq(Mux(own, item.damaged | (damaged & ~starts), damaged)),
            ]
        with m.If(self.begins):
            returns = over | draining.some
            m.d.sync += [
                x.eq(Mux(returns, 0, x + 1)),
                at_first.eq(returns),
                judging.eq(Mux(returns, self._right == 0, judging | (x == self._right - 1))),
                at_start.eq(self._at(x, self._right + self._first, returns)),
                fresh.eq((fresh | starts) & ~emits),
            ]
            with m.If(at_end):
                beyond.start(self._right)
            with m.If(beyond.some):
                beyond.step()
            with m.If(own):
                m.d.sync += [damaged.eq(item.damaged | (damaged & ~starts)), ended.eq(item.eof)]
            with m.If(starts):
                m.d.sync += [rows.eq(1), top.eq(1)]
            with m.If(draining.some):
                draining.step()
            with m.If(over):
                m.d.sync += top.eq(0)
                with m.If(unripe.some):
                    unripe.step()
                # What the row that follows knows of itself: below the frame it lies outside.
                m.d.sync += rows.eq((rows_now << 1) | (~below.some & ~ended_now))
                with m.If(below.some):
                    below.step()
                with m.Elif(ended_now):
                    below.start(self._below)
                with m.If(final):
                    draining.start(self._drain)
                    unripe.start(self._below)
                    m.d.sync += ended.eq(0)

        valid = Signal()
        first = Signal()
        last = Signal()
        step = Signal(range(self._steps))
        m.d.sync += [
            valid.eq(self.begins | going),
            first.eq(self.begins),
            last.eq(ending if self._steps > 1 else self.begins),
            step.eq(Mux(going, step + 1, 0)),
        ]
        m.d.comb += [
            self.valid.eq(valid),
            self.step.eq(step),
            self.first.eq(first),
            self.last.eq(last),
            self.slot.eq(slot),
        ]
        return m

    @staticmethod
    def _at(x: Signal, column: int, returns: Value) -> Value:
        """Whether the next column is this one; ``returns`` says that the next is a line's first."""
        return returns if column == 0 else ~returns & (x == column - 1)
