"""Decides when the slots of a raster come: for a pixel that arrives, or beyond the frame's edge."""

from amaranth.hdl import Module, Signal, Value

from softdepth.hdl.arithmetic.countdown import Countdown


class Pace:
    """Decides whether there is a slot in this clock; apart from ``valid``, from registers alone.

    Parameters
    ----------
    m : the module that this is part of.
    clocks : the fewest that a slot takes.
    credit : a register that says whether a slot may begin.
    valid, ready : of the raster; ``ready`` is driven.
    beyond : registers too: a slot takes no pixel, and input is held back.

    Members
    -------
    slot : there is one.
    rest : a slot's clocks after this one.
    """

    def __init__(
        self, m: Module, clocks: int, *, credit: Value, valid: Value, ready: Signal, beyond: Value
    ) -> None:
        self.slot = Signal(name="paced_slot")
        self.rest = Countdown(m, clocks - 1, "rest")
        may = credit & ~self.rest.some
        m.d.comb += [ready.eq(may & ~beyond), self.slot.eq(may & (beyond | valid))]
        with m.If(self.slot):
            self.rest.start(clocks - 1)
        with m.Elif(self.rest.some):
            self.rest.step()
