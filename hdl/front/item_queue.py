"""A register stage in a stream."""

from amaranth.hdl import Array, Module, ShapeLike, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out


class ItemQueue(wiring.Component):
    """Two places, so that neither side's logic reaches through to the other: one item a clock.

    Items go to the places in turn. An empty place takes whatever is offered, so that no logic but its own
    bit decides over its many registers, which may lie far away.

    Parameters
    ----------
    shape : of an item.

    Members
    -------
    i : items.
    o : the same, `latency` clocks later or when they are taken.
    """

    latency = 1
    places = 2

    def __init__(self, shape: ShapeLike) -> None:
        self._shape = shape
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        places = Array(Signal(self._shape, name=f"place_{k}", reset_less=True) for k in range(self.places))
        holds = Array(Signal(name=f"holds_{k}") for k in range(self.places))
        newest, oldest = Signal(), Signal()  # the place that is filled next, and the one that is emptied next
        m.d.comb += [
            self.i.ready.eq(~holds[newest]),
            self.o.valid.eq(holds[oldest]),
            self.o.payload.eq(places[oldest]),
        ]
        for place, held in zip(places, holds, strict=True):
            with m.If(~held):
                m.d.sync += place.eq(self.i.payload)
        with m.If(self.i.valid & self.i.ready):
            m.d.sync += [holds[newest].eq(1), newest.eq(~newest)]
        with m.If(self.o.valid & self.o.ready):
            m.d.sync += [holds[oldest].eq(0), oldest.eq(~oldest)]
        return m
