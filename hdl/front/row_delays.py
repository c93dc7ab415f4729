"""Fields of a raster as they were some rows above."""

from collections.abc import Mapping, Sequence

from amaranth.hdl import Cat, Module, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.packed_memory import PackedMemory


class RowDelays(wiring.Component):
    """Gives each field of a pixel as it was at the same column so many rows before.

    One memory holds all rows side by side: each pixel reads those above it, and writes them back moved up
    by one. What lay before the frame is stale. The same column not sooner than 4 clocks later.

    Parameters
    ----------
    bits : of each field.
    lags : how many rows before, ascending; 0 is the pixel's own row.

    Members
    -------
    enters : a pixel begins.
    stored : it lies in the frame's columns, and is kept.
    x, pixel : its column and its fields; `x` may be anything where it is not stored.
    o : of each field, one value a lag, `latency` clocks later, held until the next.
    """

    latency = 2

    def __init__(self, bits: Mapping[str, int], lags: Mapping[str, Sequence[int]], max_width: int) -> None:
        self._bits, self._lags, self._max_width = dict(bits), dict(lags), max_width
        self.layout = data.StructLayout({name: unsigned(width) for name, width in bits.items()})
        found = {name: data.ArrayLayout(unsigned(bits[name]), len(rows)) for name, rows in lags.items()}
        super().__init__(
            {
                "enters": In(1),
                "stored": In(1),
                "x": In(range(max_width)),
                "pixel": In(self.layout),
                "o": Out(data.StructLayout(found)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        deepest = {name: max(rows) for name, rows in self._lags.items()}
        # Of each field the oldest row first.
        stored = data.StructLayout({name: self._bits[name] * rows for name, rows in deepest.items()})
        m.submodules.rows = rows = PackedMemory(stored, self._max_width)
        entered, written = Signal(), Signal()
        at = [self.x]
        pixel = [self.pixel]
        for clock in range(1, 3):
            at.append(Signal.like(self.x, name=f"x_{clock}", reset_less=True))
            m.d.sync += at[-1].eq(at[-2])
        pixel.append(Signal(self.layout, name="pixel_1", reset_less=True))
        m.d.comb += [rows.read.eq(self.enters), rows.read_at.eq(self.x)]
        m.d.sync += [
            entered.eq(self.enters),
            written.eq(self.enters & self.stored),
            pixel[1].eq(self.pixel),
        ]
        columns = {}
        for name, bits in self._bits.items():
            column = Signal(bits * (deepest[name] + 1), name=f"column_{name}", reset_less=True)
            with m.If(entered):
                m.d.sync += column.eq(Cat(rows.data[name], pixel[1][name]))
            columns[name] = column
            for k, lag in enumerate(self._lags[name]):
                row = deepest[name] - lag
                m.d.comb += self.o[name][k].eq(column[row * bits : (row + 1) * bits])
        write = Signal()
        m.d.sync += write.eq(written)
        m.d.comb += [
            rows.write.eq(write),
            rows.write_at.eq(at[2]),
            *(rows.written[name].eq(columns[name][bits:]) for name, bits in self._bits.items()),
        ]
        return m
