"""Disparities in sixteenths of a pixel."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, unsigned
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.divide import divided
from softdepth.hdl.memory.delay import delayed

FRACTION_BITS = 4
QUOTIENT_BITS = FRACTION_BITS + 1


class Sixteenths(wiring.Component):
    """Where two lines of equal and opposite slope through three neighbouring costs meet. One a clock.

    With a, b, c the costs before, behind and at the winner d, and ``s = max(a, b) - c``, the result is
    ``16 d + floor(8 (a - b) / s + 1/2)``, exactly: a divider of five steps divides ``16 (a - b) + 17 s``,
    which is never negative, by ``2 s``, and its quotient is 8 too large. If a neighbour is missing or s is 0,
    the result is ``16 d``.

    Members
    -------
    winner, cost, below, above : the candidate, and the costs.
    usable : both neighbours are there.
    o : the disparity, `latency` clocks later.
    """

    latency = 2 + QUOTIENT_BITS + 1

    def __init__(self, disparities: int, bits: int) -> None:
        self._bits = bits
        winner = range(disparities)
        self._winner = (disparities - 1).bit_length()
        super().__init__(
            {
                "winner": In(winner),
                "cost": In(bits),
                "below": In(bits),
                "above": In(bits),
                "usable": In(1),
                "o": Out(unsigned(self._winner + FRACTION_BITS)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bits = self._bits
        # Clock 1: differences. Clock 2: dividend and divisor.
        rise = Signal(unsigned(bits), reset_less=True)
        skew = Signal((self.below - self.above).shape(), reset_less=True)
        larger = Mux((self.below - self.above)[-1], self.above, self.below)
        m.d.sync += [rise.eq(larger - self.cost), skew.eq(self.below - self.above)]
        usable: Value = delayed(m, self.usable, 1, "usable")
        numerator = Signal(bits + QUOTIENT_BITS + 1, reset_less=True)
        divisor = Signal(bits + 1, reset_less=True)
        good = Signal(reset_less=True)
        m.d.sync += [
            numerator.eq((skew << FRACTION_BITS) + rise + (rise << FRACTION_BITS)),
            divisor.eq(rise << 1),
            good.eq(usable & rise.any()),
        ]
        quotient = divided(m, numerator, divisor, QUOTIENT_BITS)
        winner = delayed(m, self.winner, self.latency - 1, "winner")
        late = delayed(m, good, QUOTIENT_BITS, "good")
        whole = Cat(Const(0, FRACTION_BITS), winner)
        moved = Signal.like(self.o, reset_less=True)
        m.d.sync += moved.eq(Mux(late, whole + quotient - (1 << (FRACTION_BITS - 1)), whole))
        m.d.comb += self.o.eq(moved)
        return m
