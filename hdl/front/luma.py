"""Brightness of a pixel, and the pixel from it."""

from amaranth.hdl import Cat, Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

RGB = 3


def rest_bits(channels: int, bits: int) -> int:
    """Bits that tell a pixel's colour beside its luma: red, blue, and a bit that the luma lost."""
    return 2 * bits + 1 if channels == RGB else 0


class Luma(wiring.Component):
    """``(R + 2 G + B) >> 2`` of a colour pixel; a gray pixel is its own. Wires and two adders, no register.

    Parameters
    ----------
    channels, bits : of a pixel, red lowest.

    Members
    -------
    i : a pixel.
    o : its luma, as wide as a channel.
    rest : what `Colour` needs beside it.
    """

    def __init__(self, channels: int, bits: int) -> None:
        self._channels, self._bits = channels, bits
        super().__init__({"i": In(channels * bits), "o": Out(bits), "rest": Out(rest_bits(channels, bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        parts: list[Value] = [self.i[k * self._bits : (k + 1) * self._bits] for k in range(self._channels)]
        if self._channels == RGB:
            red, green, blue = parts
            total = red + blue + (green << 1)
            m.d.comb += [self.o.eq(total >> 2), self.rest.eq(Cat(red, blue, total[1]))]
        else:
            m.d.comb += self.o.eq(parts[0])
        return m


class Colour(wiring.Component):
    """The pixel whose `Luma` and rest are given: a third less to remember than both. Two adders, no register.

    Parameters
    ----------
    channels, bits : of a pixel, red lowest.

    Members
    -------
    i, rest : its luma, and the rest.
    o : the pixel.
    """

    def __init__(self, channels: int, bits: int) -> None:
        self._channels, self._bits = channels, bits
        super().__init__({"i": In(bits), "rest": In(rest_bits(channels, bits)), "o": Out(channels * bits)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bits = self._bits
        if self._channels == RGB:
            red, blue, lost = self.rest[:bits], self.rest[bits : 2 * bits], self.rest[-1]
            # The sum's lowest bit is that of red and blue.
            twice = Cat(red[0] ^ blue[0], lost, self.i) - (red + blue)
            m.d.comb += self.o.eq(Cat(red, twice[1 : bits + 1], blue))
        else:
            m.d.comb += self.o.eq(self.i)
        return m
