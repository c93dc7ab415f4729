"""Horizontal gradient of a pixel's neighbourhood."""

from amaranth.hdl import Cat, Const, Module, Mux, Shape, Signal, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out


class Gradient(wiring.Component):
    """Horizontal Sobel, held within +-``cap``. One window a clock.

    Lumas of more than 8 bits lose those below first, so that ``cap`` speaks of 8-bit values.

    Parameters
    ----------
    bits : of a luma.

    Members
    -------
    window : 3x3 lumas, rows from above.
    o : the gradient, signed, `latency` clocks later.
    """

    latency = 3

    def __init__(self, bits: int, cap: int) -> None:
        self._bits, self._cap = bits, cap
        self.shape = Shape.cast(range(-cap, cap + 1))
        super().__init__(
            {
                "window": In(data.ArrayLayout(data.ArrayLayout(unsigned(bits), 3), 3)),
                "o": Out(self.shape),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        drop = max(self._bits - 8, 0)
        sides: list[Signal] = []
        for name, column in (("left", 0), ("right", 2)):
            above, beside, below = (Value.cast(self.window[row][column])[drop:] for row in range(3))
            sides.append(Signal(self._bits - drop + 2, name=name, reset_less=True))
            m.d.sync += sides[-1].eq(above + below + Cat(Const(0, 1), beside))
        difference = Signal(Shape(len(sides[0]) + 1, signed=True), reset_less=True)
        held = Signal(self.shape, reset_less=True)
        m.d.sync += [
            difference.eq(sides[1] - sides[0]),
            held.eq(
                Mux(
                    difference > self._cap,
                    self._cap,
                    Mux(difference < -self._cap, -self._cap, difference),
                )
            ),
        ]
        m.d.comb += self.o.eq(held)
        return m
