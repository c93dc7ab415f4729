"""How sure a winner is."""

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import CONFIDENCE_BITS


class Confidence(wiring.Component):
    """``min(255, (runner_up - cost) >> shift)``, or 0 without a runner-up. One a clock.

    Members
    -------
    cost, runner_up : the smallest cost, and that of the best candidate that is not next to it.
    has_runner_up : there is a runner-up.
    o : the confidence, `latency` clocks later.
    """

    latency = 2

    def __init__(self, bits: int, shift: int) -> None:
        self._bits, self._shift = bits, shift
        super().__init__(
            {
                "cost": In(bits),
                "runner_up": In(bits),
                "has_runner_up": In(1),
                "o": Out(unsigned(CONFIDENCE_BITS)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        margin = Signal(self._bits, reset_less=True)
        held = Signal.like(self.o, reset_less=True)
        highest = (1 << CONFIDENCE_BITS) - 1
        shifted = margin >> self._shift
        m.d.sync += [
            margin.eq(Mux(self.has_runner_up, self.runner_up - self.cost, 0)),
            held.eq(Mux(shifted > highest, highest, shifted)),
        ]
        m.d.comb += self.o.eq(held)
        return m
