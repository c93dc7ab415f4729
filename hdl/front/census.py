"""Census of a pixel: which of its neighbours are darker."""

from amaranth.hdl import Cat, Module, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

CENSUS_REACH = 3
SQUARES = tuple(
    (row, column)
    for row in range(2 * CENSUS_REACH + 1)
    for column in range(2 * CENSUS_REACH + 1)
    if (row + column) % 2 == 0 and (row, column) != (CENSUS_REACH, CENSUS_REACH)
)
"""The black squares of a 7x7 chessboard but the centre, as row and column of the window."""


class Census(wiring.Component):
    """A bit for each black square of the chessboard around a pixel: it is darker than the pixel.

    One window a clock.

    Parameters
    ----------
    bits : of a luma.

    Members
    -------
    window : lumas, rows from above.
    o : the bits, `latency` clocks later.
    """

    latency = 1

    def __init__(self, bits: int) -> None:
        side = 2 * CENSUS_REACH + 1
        super().__init__(
            {
                "window": In(data.ArrayLayout(data.ArrayLayout(unsigned(bits), side), side)),
                "o": Out(len(SQUARES)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        centre = self.window[CENSUS_REACH][CENSUS_REACH]
        # The sign of a difference comes straight out of a carry chain, a comparison does not.
        darker = [(self.window[row][column] - centre)[-1] for row, column in SQUARES]
        held = Signal(len(SQUARES), reset_less=True)
        m.d.sync += held.eq(Cat(*darker))
        m.d.comb += self.o.eq(held)
        return m
