"""Tells a pause between frames from one between lines."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from softdepth.spec.config import Config


def silent_clocks(config: Config) -> int:
    """Clocks that make a silence: those of the longest line at full rate, rounded up to a power of two."""
    return 2 ** ceil_log2(config.max_width * config.steps)


class Silence(wiring.Component):
    """Says that nothing has come for as long as a frame can be expected to go on.

    Members
    -------
    waits : something is waited for in this clock; the time starts anew whenever nothing is.
    over : the wait has lasted `silent_clocks`. Low one clock after ``waits`` is.
    """

    def __init__(self, config: Config) -> None:
        self._clocks = silent_clocks(config)
        super().__init__({"waits": In(1), "over": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        waited = Signal(range(self._clocks + 1))
        m.d.comb += self.over.eq(waited[-1])
        with m.If(~self.waits):
            m.d.sync += waited.eq(0)
        with m.Elif(~self.over):
            m.d.sync += waited.eq(waited + 1)
        return m
