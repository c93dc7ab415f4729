"""The register stage between the frame guard and the sequencer."""

from amaranth.hdl import Module, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import Config
from softdepth.hdl.frame_guard import item_layout


def placed_layout(config: Config) -> data.StructLayout:
    """An item, and where its pixel stands in the line as far as the sequencer cares.

    ``first`` : it is the line's first pixel. ``completes`` : with it, the line's first pixel has all that
    it sees to its right. ``inner`` : with it, a pixel is complete whose support lies inside the image;
    ``first_inner`` : it is the first of these.
    """
    return data.StructLayout(
        {**item_layout(config).members, "first": 1, "completes": 1, "inner": 1, "first_inner": 1}
    )


class ItemQueue(wiring.Component):
    """Two places, so that neither side's logic reaches through to the other: one item a clock.

    Members
    -------
    i : items of the frame guard.
    o : the same, with their places, `latency` clocks later or when they are taken.
    """

    latency = 1

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "i": In(stream.Signature(item_layout(config))),
                "o": Out(stream.Signature(placed_layout(config))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        support = config.reach_left + config.reach_right
        placed = Signal(placed_layout(config))
        m.d.comb += [
            *[placed[name].eq(self.i.payload[name]) for name in item_layout(config).members],
            placed.first.eq(self.i.payload.x == 0),
            placed.completes.eq(self.i.payload.x == config.reach_right),
            placed.inner.eq(self.i.payload.x >= support),
            placed.first_inner.eq(self.i.payload.x == support),
        ]
        # The spare place takes the item that comes while the output waits.
        waiting = Signal()
        spare = Signal(placed_layout(config), reset_less=True)
        output = Signal(placed_layout(config), reset_less=True)
        moves = Signal()
        m.d.comb += [
            self.i.ready.eq(~waiting),
            self.o.payload.eq(output),
            moves.eq(self.o.ready | ~self.o.valid),
        ]
        with m.If(~waiting):
            m.d.sync += spare.eq(placed)
        with m.If(moves):
            m.d.sync += [self.o.valid.eq(waiting | self.i.valid), waiting.eq(0)]
            with m.If(waiting):
                m.d.sync += output.eq(spare)
            with m.Else():
                m.d.sync += output.eq(placed)
        with m.Elif(~waiting):
            m.d.sync += waiting.eq(self.i.valid)
        return m
