"""Turns starts of frames and ends of lines into the core's markers."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

GEOMETRY_BITS = 16


class Markers(wiring.Component):
    """Finds the ends of lines and frames, by marks or by the geometry that was set, in the same clock.

    Members
    -------
    taken : a pixel is taken in this clock.
    sof, last : its marks: start of a frame, end of a line.
    width, height : the geometry that was set; 0 means that it was not.
    eol, eof : the pixel ends a line, or a frame. Without a height, ``eof`` is 0.
    between : the next pixel begins a line.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "taken": In(1),
                "sof": In(1),
                "last": In(1),
                "width": In(GEOMETRY_BITS),
                "height": In(GEOMETRY_BITS),
                "eol": Out(1),
                "eof": Out(1),
                "between": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # Counted from 1, like the geometry; a start of frame is at 1 whatever the counters say.
        columns = Signal(GEOMETRY_BITS, init=1)
        rows = Signal(GEOMETRY_BITS, init=1)
        column, row = Mux(self.sof, 1, columns), Mux(self.sof, 1, rows)
        m.d.comb += [
            self.eol.eq(Mux(self.width.any(), column == self.width, self.last)),
            self.eof.eq(self.eol & (row == self.height)),
            self.between.eq(columns == 1),
        ]
        with m.If(self.taken):
            m.d.sync += [
                columns.eq(Mux(self.eol, 1, column + 1)),
                rows.eq(row + self.eol),
            ]
        return m
