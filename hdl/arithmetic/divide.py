"""Division by subtraction, a bit a clock."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value


def divided(m: Module, dividend: Value, divisor: Value, bits: int) -> Value:
    """``dividend // divisor``, known to take ``bits`` bits, so many clocks later. One a clock."""
    rest, found = dividend, list[Value]()
    for bit in reversed(range(bits)):
        difference = rest - (divisor << bit)
        fits = ~difference[-1]
        left = Signal(len(rest), name=f"rest_{bit}", reset_less=True)
        held = Signal(len(divisor), name=f"divisor_{bit}", reset_less=True)
        quotient = Signal(len(found) + 1, name=f"quotient_{bit}", reset_less=True)
        m.d.sync += [
            left.eq(Mux(fits, difference, rest)),
            held.eq(divisor),
            quotient.eq(Cat(fits, *found)),
        ]
        rest, divisor, found = left, held, list(quotient)
    return Cat(*found)
