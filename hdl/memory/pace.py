"""When the slots of a raster are: of a pixel that comes, or of what lies beyond the frame's edge."""

from amaranth.hdl import Module, Signal, Value

from softdepth.hdl.arithmetic.countdown import Countdown


class Pace:
    """Decides by registers alone, but for what is offered, whether there is a slot in this clock.

    Parameters
    ----------
    m : the module that this is part of.
    clocks : of a slot, at least.
    credit : a slot may be, as a register says.
    valid, ready : of the raster; ``ready`` is driven.
    beyond : conditions, registers too, in which a slot is not of a pixel that comes: input is held back.

    Members
    -------
    slot : there is one.
    rest : its clocks after this one.
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
