"""A register stage in a stream."""

from amaranth.hdl import Array, Module, Mux, ShapeLike, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out


class ItemQueue(wiring.Component):
    """Places for items, so that neither side's logic reaches through to the other.

    Items go to the places in turn. An empty place takes whatever is offered, so that a register alone decides
    over its many bits, which may lie far away; ``i.ready`` and ``o.valid`` are registers too. With two
    places, one item a clock; with one, an item every other clock, and ``o.payload`` is a register.

    Parameters
    ----------
    shape : of an item.
    places : 1 or 2.

    Members
    -------
    i : items.
    o : the same, `latency` clocks later or when they are taken.
    """

    latency = 1
    places = 2

    def __init__(self, shape: ShapeLike, *, places: int = places) -> None:
        if places not in (1, 2):
            raise ValueError(f"a queue of {places} places, but it is built with 1 or 2")
        self._shape, self.places = shape, places
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        places = Array(Signal(self._shape, name=f"place_{k}", reset_less=True) for k in range(self.places))
        comes = Signal()
        goes = Signal()
        m.d.comb += [
            comes.eq(self.i.valid & self.i.ready),
            goes.eq(self.o.valid & self.o.ready),
        ]
        if self.places == 1:
            full = Signal()
            m.d.sync += full.eq(Mux(full, ~goes, comes))
            m.d.comb += [self.i.ready.eq(~full), self.o.valid.eq(full), self.o.payload.eq(places[0])]
            with m.If(~full):
                m.d.sync += places[0].eq(self.i.payload)
            return m
        oldest = Signal()  # the place that is emptied next
        holding = Signal()  # one place at least holds an item
        full = Signal()  # both do
        m.d.comb += [
            self.i.ready.eq(~full),
            self.o.valid.eq(holding),
            self.o.payload.eq(places[oldest]),
        ]
        # `holding`, `full` and `oldest` in the next clock.
        held = Signal()
        both = Signal()
        next_out = Signal()
        m.d.comb += [
            held.eq(comes | full | (holding & ~goes)),
            both.eq(~goes & (full | (comes & holding))),
            next_out.eq(oldest ^ goes),
        ]
        m.d.sync += [holding.eq(held), full.eq(both), oldest.eq(next_out)]
        for number, place in enumerate(places):
            empty = Signal(name=f"empty_{number}", init=1)
            m.d.sync += empty.eq(~both & ~(held & (next_out == number)))
            with m.If(empty):
                m.d.sync += place.eq(self.i.payload)
        return m


def places_for(clocks: int) -> int:
    """Places of an `ItemQueue` that lets an item through every so many clocks, and costs least."""
    return 1 if clocks > 1 else 2


def waiting_time(places: int, clocks: int) -> int:
    """How much longer than `ItemQueue.latency` an item waits where more are always on offer.

    One leaves every ``clocks`` clocks, at least 2 with one place. Another enters a clock later, and leaves
    ``places * clocks`` clocks after that one did.
    """
    return places * clocks - 1 - ItemQueue.latency
