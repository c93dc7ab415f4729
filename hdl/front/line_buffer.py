"""Line buffer: turns a raster of pixels into columns of neighbouring rows."""

from amaranth.hdl import Cat, Module, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.sliced_memory import SlicedMemory


class LineBuffer(wiring.Component):
    """Keeps the last ``rows - 1`` lines in block RAM and gives the column that ends in the new pixel.

    One memory holds all lines side by side: each pixel reads the column above it and writes it back
    moved up by one row. Rows from before the frame hold stale pixels; results that would see them
    are border results.

    Parameters
    ----------
    width : bits of a pixel.
    rows : rows of a column, the new pixel's included.
    max_width : pixels of the longest line. Lines of fewer than three pixels are not supported.

    Members
    -------
    en, x, pixel : a pixel of column ``x`` enters at a clock with ``en`` high.
    column : its column, top row first, `latency` clocks later, held until the next.
    """

    latency = 4

    def __init__(self, width: int, rows: int, max_width: int) -> None:
        self._width = width
        self._rows = rows
        self._depth = max_width
        super().__init__(
            {
                "en": In(1),
                "x": In(range(max_width)),
                "pixel": In(width),
                "column": Out(data.ArrayLayout(unsigned(width), rows)),
            }
        )

    @property
    def bits(self) -> int:
        """Bits of memory."""
        return self._width * (self._rows - 1) * self._depth

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # The memory's inputs come from registers: its blocks lie far apart.
        entering = Signal()
        entered = Signal()
        x = Signal(range(self._depth), reset_less=True)
        entering_pixel = Signal(self._width, reset_less=True)
        pixel = Signal(self._width, reset_less=True)
        column = Signal(data.ArrayLayout(unsigned(self._width), self._rows))
        held = Signal.like(column, reset_less=True)
        m.d.sync += [
            entering.eq(self.en),
            entered.eq(entering),
            x.eq(self.x),
            entering_pixel.eq(self.pixel),
            pixel.eq(entering_pixel),
        ]
        with m.If(entered):
            m.d.sync += held.eq(column)
        # From here on the column is on its way to all lanes.
        leaving = Signal.like(column, reset_less=True)
        m.d.sync += leaving.eq(held)
        m.d.comb += self.column.eq(leaving)
        if self._rows == 1:
            m.d.comb += column[0].eq(pixel)
            return m

        # What is written back comes from the output's registers, which block RAM has of its own.
        m.submodules.lines = lines = SlicedMemory(self._width * (self._rows - 1), self._depth)
        read_at = Signal.like(x)
        written_at = Signal.like(x)
        m.d.comb += [
            lines.read.eq(entering),
            lines.read_at.eq(x),
            column.as_value().eq(Cat(lines.data, pixel)),
            lines.write_at.eq(written_at),
            lines.written.eq(held.as_value()[self._width :]),
        ]
        m.d.sync += [lines.write.eq(entered), read_at.eq(x), written_at.eq(read_at)]
        return m
