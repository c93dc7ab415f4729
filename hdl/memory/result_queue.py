"""The queue at a free-running pipeline's end, and the credits that keep it from overflowing."""

from amaranth.hdl import Module, ShapeLike, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.fifo import SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

QUEUE_LATENCY = 2
"""Clocks from a write to the output."""


class ResultQueue(wiring.Component):
    """Lets a pipeline that cannot stop end in a stream that may be held back.

    A place is promised to each result when its computation begins. While places are left, more may
    begin: so back-pressure reaches the pipeline's input, and nothing inside needs an enable. One result
    a clock.

    Parameters
    ----------
    shape : of a result.
    latency : clocks from a promise to its `put`.

    Members
    -------
    credit : a result may be promised in this clock.
    promised : one is.
    dropped : a result that was promised does not come.
    put, result : a promised result arrives.
    o : the results, in order.
    """

    def __init__(self, shape: ShapeLike, latency: int) -> None:
        self._shape = shape
        self._depth = latency + QUEUE_LATENCY + 2
        super().__init__(
            {
                "credit": Out(1),
                "promised": In(1),
                "dropped": In(1),
                "put": In(1),
                "result": In(shape),
                "o": Out(stream.Signature(shape)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        result = Signal(self._shape)
        m.d.comb += result.eq(self.result)
        m.submodules.fifo = fifo = SyncFIFOBuffered(width=len(result.as_value()), depth=self._depth)
        m.d.comb += [
            fifo.w_en.eq(self.put),
            fifo.w_data.eq(result),
            self.o.valid.eq(fifo.r_rdy),
            self.o.payload.eq(fifo.r_data),
            fifo.r_en.eq(self.o.ready),
        ]
        left = Signal(range(self._depth + 1), init=self._depth)
        m.d.sync += left.eq(left - self.promised + self.dropped + (self.o.valid & self.o.ready))
        m.d.comb += self.credit.eq(left != 0)
        return m
