"""A fuzzy cost as a whole number."""

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.divide import divided
from softdepth.hdl.memory.delay import delayed
from softdepth.spec.config import QUOTIENT_BITS


def number_latency(low: int, high: int) -> int:
    """Of a `Number`: the dividend, a clock for each bit, and the choice."""
    return 1 + (high - low).bit_length() + 1


class Number(wiring.Component):
    """``floor(num * 2**QUOTIENT_BITS / den)``, held within a range, counted from its lower end. One a clock.

    A fraction with a ``den`` of 0 is infinite: the upper end.

    Parameters
    ----------
    cost : layout of a fraction.
    low, high : the range, `Config.number_range`, from the negative of a power of two to it, less 1.

    Members
    -------
    i : a fraction.
    o : the number less ``low``, `latency` clocks later.
    """

    def __init__(self, cost: data.StructLayout, low: int, high: int) -> None:
        assert low == -high - 1
        self._bits = (high - low).bit_length()
        self.latency = number_latency(low, high)
        super().__init__({"i": In(cost), "o": Out(unsigned(self._bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bits = self._bits
        sum_of = (self.i.num << QUOTIENT_BITS) + (self.i.den << bits - 1)
        dividend = Signal(sum_of.shape(), reset_less=True)
        divisor = Signal(self.i.den.shape(), reset_less=True)
        m.d.sync += [dividend.eq(sum_of), divisor.eq(self.i.den)]
        under = dividend[-1]
        over = ~(dividend - (divisor << bits))[-1]
        # Where the number is neither under nor over, the division is exact.
        quotient = divided(m, dividend[:-1], divisor, bits)
        is_under = delayed(m, under, bits, "under")
        is_over = delayed(m, over, bits, "over")
        held = Signal.like(self.o, reset_less=True)
        m.d.sync += held.eq(Mux(is_under, 0, Mux(is_over, (1 << bits) - 1, quotient)))
        m.d.comb += self.o.eq(held)
        return m
