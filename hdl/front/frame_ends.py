"""A frame's end, on its last pixel."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.frame_guard import item_layout
from softdepth.hdl.memory.window import MARKERS, raster_layout
from softdepth.spec.config import Config


class FrameEnds(wiring.Component):
    """Turns the guard's items into a raster: ends that came without a pixel are put on the one before.

    A pixel that ends a line but no frame may turn out to be the last, so it waits for the item that follows.
    All others pass in the clock after they came. A pixel a clock.

    Members
    -------
    i : items of well-formed frames.
    o : `raster_layout` of both views' pixels, left lowest, `latency` clocks later where nothing waits.
    """

    latency = 1

    def __init__(self, config: Config) -> None:
        self._item = item_layout(config)
        members = self._item.members
        self._pair = data.StructLayout({"left": members["left"], "right": members["right"]})
        super().__init__(
            {
                "i": In(stream.Signature(self._item)),
                "o": Out(stream.Signature(raster_layout(self._pair.size))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        held = Signal(self._item, reset_less=True)
        full = Signal()
        item = self.i.payload
        waits = Signal()
        m.d.comb += [
            waits.eq(held.eol & ~held.eof),
            self.o.valid.eq(full & (~waits | self.i.valid)),
            self.o.payload.element.eq(Cat(held.left, held.right)),
            *(self.o.payload[name].eq(held[name]) for name in MARKERS),
            self.i.ready.eq(~full | self.o.ready),
        ]
        with m.If(waits & item.end):
            m.d.comb += [self.o.payload.eof.eq(1), self.o.payload.damaged.eq(item.damaged | held.damaged)]
        with m.If(self.i.valid & self.i.ready):
            # An end without a pixel leaves with the one before: it takes no place.
            m.d.sync += [full.eq(~item.end), held.eq(item)]
        with m.Elif(self.o.valid & self.o.ready):
            m.d.sync += full.eq(0)
        return m
