"""A register stage in a stream."""

from amaranth.hdl import Module, ShapeLike, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out


class ItemQueue(wiring.Component):
    """Two places, so that neither side's logic reaches through to the other: one item a clock.

    Parameters
    ----------
    shape : of an item.

    Members
    -------
    i : items.
    o : the same, `latency` clocks later or when they are taken.
    """

    latency = 1

    def __init__(self, shape: ShapeLike) -> None:
        self._shape = shape
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # The spare place takes the item that comes while the output waits.
        waiting = Signal()
        spare = Signal(self._shape, reset_less=True)
        output = Signal(self._shape, reset_less=True)
        moves = Signal()
        m.d.comb += [
            self.i.ready.eq(~waiting),
            self.o.payload.eq(output),
            moves.eq(self.o.ready | ~self.o.valid),
        ]
        with m.If(~waiting):
            m.d.sync += spare.eq(self.i.payload)
        with m.If(moves):
            m.d.sync += [self.o.valid.eq(waiting | self.i.valid), waiting.eq(0)]
            with m.If(waiting):
                m.d.sync += output.eq(spare)
            with m.Else():
                m.d.sync += output.eq(self.i.payload)
        with m.Elif(~waiting):
            m.d.sync += waiting.eq(self.i.valid)
        return m
