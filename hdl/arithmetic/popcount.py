"""How many bits are set, in full adders of look-up tables."""

from collections.abc import Iterable

from amaranth.hdl import Cat, Module, Signal, Value


def popcount(m: Module, bits: Iterable[Value]) -> Value:
    """The number of bits that are set, as wide as their number needs, without a register.

    Three bits of a weight become one of it and one of the next, until one of each is left. Carry chains
    would be longer than the numbers on them.
    """

    def wire(value: Value) -> Signal:
        signal = Signal(name="part")
        m.d.comb += signal.eq(value)
        return signal

    column: list[Value] = list(bits)
    total: list[Value] = []
    while column:
        following: list[Value] = []
        while len(column) > 1:
            a, b, *rest = column
            odd = wire(a ^ b)
            if rest:
                c, *rest = rest
                following.append(wire((a & b) | (c & odd)))
                odd = wire(odd ^ c)
            else:
                following.append(wire(a & b))
            column = [*rest, odd]
        total += column
        column = following
    return Cat(*total)
