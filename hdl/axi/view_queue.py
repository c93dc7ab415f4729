"""Keeps one view's pixels until the other view's arrive."""

from amaranth.hdl import ClockDomain, ClockSignal, Module, ResetSignal, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.cdc import ResetSynchronizer
from amaranth.lib.fifo import AsyncFIFOBuffered, SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.item_queue import ItemQueue


def view_layout(bits: int) -> data.StructLayout:
    """A pixel of ``bits``, and its marks: it starts a frame, it ends a line."""
    return data.StructLayout({"pixel": bits, "sof": 1, "last": 1})


class ViewQueue(wiring.Component):
    """A queue in block RAM, with a register stage behind it: a pixel a clock.

    With a clock of its own, the stream ``i`` is synchronous to that clock, and Amaranth's
    `AsyncFIFOBuffered` carries pixels across; its depth is a power of two plus one. The core's reset crosses
    the other way, a clock late, and resets both sides. Once it has arrived, nothing is taken.

    Parameters
    ----------
    bits : of a pixel.
    depth : pixels that it holds, at least.
    own_clock : whether ``i`` is synchronous to ``clk`` instead of the core's clock.

    Members
    -------
    clk : of ``i``, with ``own_clock``.
    i, o : streams of `view_layout`.
    full : no room is left.
    """

    def __init__(self, bits: int, depth: int, *, own_clock: bool = False) -> None:
        self._layout, self._depth, self._own_clock = view_layout(bits), depth, own_clock
        super().__init__(
            {
                **({"clk": In(1)} if own_clock else {}),
                "i": In(stream.Signature(self._layout)),
                "o": Out(stream.Signature(self._layout)),
                "full": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        size, resets = self._layout.size, Signal()
        if self._own_clock:
            m.domains.source = ClockDomain(local=True)
            crosses = Signal(reset_less=True)  # what crosses must come from a register
            m.d.sync += crosses.eq(ResetSignal("sync"))
            m.submodules.reset = ResetSynchronizer(crosses, domain="source")
            m.d.comb += [ClockSignal("source").eq(self.clk), resets.eq(ResetSignal("source"))]
            fifo = AsyncFIFOBuffered(width=size, depth=self._depth, r_domain="sync", w_domain="source")
        else:
            m.d.comb += resets.eq(ResetSignal("sync"))
            fifo = SyncFIFOBuffered(width=size, depth=self._depth)
        m.submodules.fifo = fifo
        m.submodules.behind = behind = ItemQueue(self._layout)
        m.d.comb += [
            fifo.w_data.eq(self.i.payload),
            fifo.w_en.eq(self.i.valid & self.i.ready),
            self.i.ready.eq(fifo.w_rdy & ~resets),
            behind.i.payload.eq(fifo.r_data),
            behind.i.valid.eq(fifo.r_rdy),
            fifo.r_en.eq(behind.i.ready),
            self.full.eq(fifo.r_level == fifo.depth),
        ]
        wiring.connect(m, behind.o, wiring.flipped(self.o))
        return m
