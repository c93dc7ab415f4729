"""What was not measured is filled from its row."""

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.fifo import SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.item_queue import ItemQueue
from softdepth.hdl.post.layout import is_measured, post_layout
from softdepth.spec.validity import Validity


class Fill(wiring.Component):
    """Gives a result that is no measurement the smaller of the row's nearest measurements left and right.

    Measured values wait in a queue of their own, and after those of each row a mark: its head is the
    nearest to the right as soon as that has come in, the last one that left it the nearest to the left.
    Filled results have confidence 0. In a row without any the value is 0, and the code says so. A result a
    clock, but for a clock a line; a result waits for the next measurement of its row.

    Members
    -------
    i, o : results, `post_layout`.
    """

    latency = 4
    """Of a measurement; what has none waits for the next, or the line's end."""

    def __init__(self, value_bits: int, colour_bits: int, max_width: int) -> None:
        self._layout = post_layout(value_bits, colour_bits)
        self._value_bits = value_bits
        self._depth = max_width + 4  # a line, its mark, and what is on its way out
        super().__init__({"i": In(stream.Signature(self._layout)), "o": Out(stream.Signature(self._layout))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        entry = data.StructLayout({"value": self._value_bits, "mark": 1})
        m.submodules.results = results = SyncFIFOBuffered(width=self._layout.size, depth=self._depth)
        m.submodules.values = values = SyncFIFOBuffered(width=entry.size, depth=self._depth)

        marks = Signal()  # the line is over: its mark goes in
        taken = Signal()
        new = Signal(entry)
        payload = self.i.payload
        m.d.comb += [
            self.i.ready.eq(~marks & results.w_rdy & values.w_rdy),
            taken.eq(self.i.valid & self.i.ready),
            results.w_en.eq(taken),
            results.w_data.eq(payload),
            new.value.eq(payload.value),
            new.mark.eq(marks),
            values.w_data.eq(new),
            values.w_en.eq((taken & is_measured(payload.code)) | marks),
        ]
        with m.If(marks):
            m.d.sync += marks.eq(~values.w_rdy)
        with m.Else():
            m.d.sync += marks.eq(taken & payload.eol)

        # What block RAM gives late is decided upon a clock later.
        m.submodules.next_result = next_result = ItemQueue(self._layout)
        m.submodules.next_value = next_value = ItemQueue(entry)
        for fifo, queue in ((results, next_result), (values, next_value)):
            m.d.comb += [
                queue.i.valid.eq(fifo.r_rdy),
                fifo.r_en.eq(queue.i.ready),
                Value.cast(queue.i.payload).eq(fifo.r_data),
            ]
        result, head = next_result.o.payload, next_value.o.payload
        ending = Signal()  # the line has left: so does its mark
        last, any_left = Signal(self._value_bits, reset_less=True), Signal()
        measured = Signal()
        left_is_smaller = Signal()
        nothing = Signal()
        m.d.comb += [
            measured.eq(is_measured(result.code)),
            left_is_smaller.eq(any_left & (head.mark | (last < head.value))),
            nothing.eq(~any_left & head.mark),
        ]
        # A register behind the choice, which the queues' outputs are far from.
        gives = Signal()
        full = Signal()
        chosen = Signal(self._layout, reset_less=True)
        m.d.comb += [
            gives.eq(next_result.o.valid & next_value.o.valid & ~ending & (~full | self.o.ready)),
            next_result.o.ready.eq(gives),
            next_value.o.ready.eq((gives & measured) | ending),
            self.o.valid.eq(full),
            self.o.payload.eq(chosen),
        ]
        with m.If(gives):
            m.d.sync += [full.eq(1), chosen.eq(result), ending.eq(result.eol)]
            with m.If(measured):
                m.d.sync += [last.eq(result.value), any_left.eq(1)]
            with m.Else():
                m.d.sync += [
                    chosen.value.eq(Mux(nothing, 0, Mux(left_is_smaller, last, head.value))),
                    chosen.code.eq(Mux(nothing, Validity.NOTHING, Validity.FILLED)),
                    chosen.confidence.eq(0),
                ]
        with m.Elif(self.o.ready):
            m.d.sync += full.eq(0)
        with m.If(ending & next_value.o.valid):
            m.d.sync += [ending.eq(0), any_left.eq(0)]
        return m
