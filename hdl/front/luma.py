"""Brightness of a pixel."""

from amaranth.hdl import Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

RGB = 3


class Luma(wiring.Component):
    """``(R + 2 G + B) >> 2`` of a colour pixel; a gray pixel is its own. Wires and two adders, no register.

    Parameters
    ----------
    channels, bits : of a pixel, red lowest.

    Members
    -------
    i : a pixel.
    o : its luma, as wide as a channel.
    """

    def __init__(self, channels: int, bits: int) -> None:
        self._channels, self._bits = channels, bits
        super().__init__({"i": In(channels * bits), "o": Out(bits)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        parts: list[Value] = [self.i[k * self._bits : (k + 1) * self._bits] for k in range(self._channels)]
        if self._channels == RGB:
            red, green, blue = parts
            m.d.comb += self.o.eq((red + blue + (green << 1)) >> 2)
        else:
            m.d.comb += self.o.eq(parts[0])
        return m
