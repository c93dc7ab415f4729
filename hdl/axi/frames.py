"""Whether frames are in the core, how many have left, and the size of the last one."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.markers import GEOMETRY_BITS

COUNT_BITS = 32


class Frames(wiring.Component):
    """Counts frames as they begin and end, and the pixels and lines of those that have ended.

    Parameters
    ----------
    most : the largest number of frames in the core at once.

    Members
    -------
    begins : a frame's first pixel is taken in this clock.
    leaves, eol, eof : a result leaves, and its markers.
    clear : sets ``count`` to 0.
    busy : results are still to come.
    ended : a frame's last result left in the clock before.
    count, width, height : frames that have ended, and the geometry of the latest.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        super().__init__(
            {
                **{name: In(1) for name in ("begins", "leaves", "eol", "eof", "clear")},
                "busy": Out(1),
                "ended": Out(1),
                "count": Out(COUNT_BITS),
                "width": Out(GEOMETRY_BITS),
                "height": Out(GEOMETRY_BITS),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        inside = Signal(range(self._most + 1))
        ends = self.leaves & self.eof
        m.d.sync += inside.eq(inside + self.begins - ends)
        m.d.comb += self.busy.eq(inside.any())

        column = Signal(GEOMETRY_BITS, init=1)
        row = Signal(GEOMETRY_BITS, init=1)
        width = Signal(GEOMETRY_BITS)
        height = Signal(GEOMETRY_BITS)
        count = Signal(COUNT_BITS)
        ended = Signal()
        with m.If(self.leaves):
            m.d.sync += column.eq(Mux(self.eol, 1, column + 1))
            with m.If(self.eol):
                m.d.sync += row.eq(Mux(self.eof, 1, row + 1))
        with m.If(ends):
            m.d.sync += [width.eq(column), height.eq(row)]
        m.d.sync += [ended.eq(ends), count.eq(Mux(self.clear, 0, count + ends))]
        m.d.comb += [
            self.ended.eq(ended),
            self.count.eq(count),
            self.width.eq(width),
            self.height.eq(height),
        ]
        return m
