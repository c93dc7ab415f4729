"""Counts the steps of a pixel."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


class StepCounter(wiring.Component):
    """Gives each pixel ``steps`` clocks, and says a clock ahead when the next one may begin.

    Parameters
    ----------
    steps : clocks of a pixel.

    Members
    -------
    load : a pixel begins; not while ``held``.
    credit : in the next clock there is room for another result.
    held : no pixel may begin in this clock, because one has steps left or there is no credit.
    valid, first, last, step : a step is taken, from the clock after ``load`` on.
    """

    latency = 1

    def __init__(self, steps: int) -> None:
        self._steps = steps
        super().__init__(
            {
                "load": In(1),
                "credit": In(1),
                "held": Out(1),
                "valid": Out(1),
                "first": Out(1),
                "last": Out(1),
                "step": Out(range(steps)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        goes_on = Signal()  # another step of this pixel follows
        more = Signal()  # and so it will in the next clock
        m.d.comb += more.eq(Mux(goes_on, self.step != self._steps - 2, self.load & (self._steps > 1)))
        m.d.sync += [
            self.valid.eq(self.load | goes_on),
            goes_on.eq(more),
            self.held.eq(more | ~self.credit),
            self.step.eq(Mux(goes_on, self.step + 1, 0)),
        ]
        m.d.comb += [
            self.first.eq(self.step == 0),
            self.last.eq(self.valid & ~goes_on),
        ]
        return m
