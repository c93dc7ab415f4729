"""Fills pixels without a measurement from their own row."""

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.packed_queue import PackedQueue
from softdepth.hdl.post.stage import PostStage, StageTime
from softdepth.hdl.winners.layout import is_measured, post_layout
from softdepth.spec.config import CONFIDENCE_BITS
from softdepth.spec.validity import Validity

UNMEASURED = 3
"""Stands where a measured result has its end: this result is not measured, and its end is elsewhere."""


def _waiting_layout(colour_bits: int) -> data.StructLayout:
    """A result in the queue, two words of 18 bits with colour; its value waits among the measured ones.

    ``end`` : 0, 1 for a line's last and 2 for a frame's, or `UNMEASURED`.
    ``about`` : the confidence of a measurement, else that end.
    """
    return data.StructLayout(
        {
            "colour": unsigned(colour_bits),
            "about": unsigned(CONFIDENCE_BITS),
            "partial": 1,
            "damaged": 1,
            "end": unsigned(2),
        }
    )


class Fill(PostStage):
    """Gives each result without a measurement the smaller of the row's nearest measurements left and right.

    Measured values wait in a queue of their own, with a mark after those of each row. The head of the queue,
    once it has arrived, is the nearest measurement to the right; the last one to leave is the nearest to the
    left. Filled results have confidence 0. In a row without measurements, the value is 0 and the code says
    so. One result a clock, except for one clock a line; a result waits for the next measurement of its row.

    Members
    -------
    i, o : results, `post_layout`.
    """

    latency = PackedQueue.latency + ItemQueue.latency
    """Of a measurement; a result without one waits for the next measurement, or for the end of the line."""

    def __init__(self, value_bits: int, colour_bits: int, max_width: int) -> None:
        self._layout = post_layout(value_bits, colour_bits)
        self._value_bits, self._colour_bits, self._max_width = value_bits, colour_bits, max_width
        super().__init__({"i": In(stream.Signature(self._layout)), "o": Out(stream.Signature(self._layout))})

    @property
    def time(self) -> StageTime:
        return StageTime(self.latency)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        entry = data.StructLayout({"value": self._value_bits, "mark": 1})
        waiting = _waiting_layout(self._colour_bits)
        m.submodules.results = results = PackedQueue(waiting, self._max_width)
        m.submodules.values = values = PackedQueue(entry, self._max_width)

        marks = Signal()  # the line is over: its mark goes in
        taken = Signal()
        payload, into = self.i.payload, results.i.payload
        is_one = is_measured(payload.code)
        end = Mux(payload.eof, 2, payload.eol)
        m.d.comb += [
            self.i.ready.eq(~marks & results.i.ready & values.i.ready),
            taken.eq(self.i.valid & self.i.ready),
            results.i.valid.eq(taken),
            into.colour.eq(payload.colour),
            into.about.eq(Mux(is_one, payload.confidence, end)),
            into.partial.eq(payload.code == Validity.PARTIAL),
            into.damaged.eq(payload.damaged),
            into.end.eq(Mux(is_one, end, UNMEASURED)),
            values.i.payload.value.eq(payload.value),
            values.i.payload.mark.eq(marks),
            values.i.valid.eq((taken & is_one) | marks),
        ]
        with m.If(marks):
            m.d.sync += marks.eq(~values.i.ready)
        with m.Else():
            m.d.sync += marks.eq(taken & payload.eol)

        result, head = results.o.payload, values.o.payload
        measured = Signal()
        ends = Signal(2)
        m.d.comb += [
            measured.eq(result.end != UNMEASURED),
            ends.eq(Mux(measured, result.end, result.about)),
        ]
        ending = Signal()  # the line has left: so does its mark
        last = Signal(self._value_bits, reset_less=True)
        any_left = Signal()
        left_is_smaller = Signal()
        nothing = Signal()
        m.d.comb += [
            left_is_smaller.eq(any_left & (head.mark | (last < head.value))),
            nothing.eq(~any_left & head.mark),
        ]
        # Places behind the choice, because the queues' outputs are far away, and to keep ``ready`` from
        # reaching through to them.
        m.submodules.chosen = places = ItemQueue(self._layout)
        chosen = places.i.payload
        gives = Signal()
        fresh = Signal(init=1)  # the frame's first result has not left
        m.d.comb += [
            gives.eq(results.o.valid & values.o.valid & ~ending & places.i.ready),
            results.o.ready.eq(gives),
            values.o.ready.eq((gives & measured) | ending),
            places.i.valid.eq(gives),
            chosen.colour.eq(result.colour),
            chosen.damaged.eq(result.damaged),
            chosen.sof.eq(fresh),
            chosen.eol.eq(ends != 0),
            chosen.eof.eq(ends == 2),
        ]
        wiring.connect(m, places.o, wiring.flipped(self.o))
        with m.If(measured):
            m.d.comb += [
                chosen.value.eq(head.value),
                chosen.code.eq(Mux(result.partial, Validity.PARTIAL, Validity.FULL)),
                chosen.confidence.eq(result.about),
            ]
        with m.Else():
            m.d.comb += [
                chosen.value.eq(Mux(nothing, 0, Mux(left_is_smaller, last, head.value))),
                chosen.code.eq(Mux(nothing, Validity.NOTHING, Validity.FILLED)),
            ]
        with m.If(gives):
            m.d.sync += [ending.eq(ends != 0), fresh.eq(ends == 2)]
            with m.If(measured):
                m.d.sync += [last.eq(head.value), any_left.eq(1)]
        with m.If(ending & values.o.valid):
            m.d.sync += [ending.eq(0), any_left.eq(0)]
        return m
