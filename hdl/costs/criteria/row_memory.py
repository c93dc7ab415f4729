"""A candidate's row costs on earlier lines, in block RAM."""

from amaranth.hdl import Cat, Module, ShapeLike, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.sliced_memory import SlicedMemory

LOOKUP_AHEAD = 2
"""How many clocks a place is looked up before its columns are there to compare."""


class RowMemory(wiring.Component):
    """Remembers the costs that a lane computed at the same place of the last ``rows`` lines.

    The cost of each of a window's rows, at a column and a candidate, was computed once already, when it was
    the newest row that the lane looks at. It is kept here, so it need not be computed again. Rows from before
    the frame hold stale costs, which only border results see.

    Parameters
    ----------
    shape : of a row's cost.
    rows : lines to remember.
    places : pixels of the longest line, times candidates of a pixel. At least 4 are in use.

    Members
    -------
    valid, place : a place is looked up.
    newest : the place's cost on the newest line, `latency` clocks later; it is remembered.
    rows : its costs on the lines before, oldest first, in the same clock as ``newest``.
    """

    latency = 4

    def __init__(self, shape: ShapeLike, rows: int, places: int) -> None:
        self._layout = data.ArrayLayout(shape, rows)
        self._places = places
        super().__init__(
            {
                "valid": In(1),
                "place": In(range(places)),
                "newest": In(shape),
                "rows": Out(self._layout),
            }
        )

    @property
    def bits(self) -> int:
        """Bits of memory."""
        return self._layout.size * self._places

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.costs = costs = SlicedMemory(self._layout, self._places)
        # A register before the memory, as places have a long way to the lanes, and two behind it: its own,
        # and one that may lie beside the adders.
        read = Signal(self._layout, reset_less=True)
        rows = Signal(self._layout, reset_less=True)
        m.d.sync += [read.eq(costs.data), rows.eq(read)]
        valid = travelling(m, self.valid, self.latency, "valid")
        place = [self.place]
        for clock in range(1, self.latency + 1):
            place.append(Signal(range(self._places), name=f"place_{clock}", reset_less=True))
            m.d.sync += place[clock].eq(place[clock - 1])
        m.d.comb += [
            costs.read.eq(valid[1]),
            costs.read_at.eq(place[1]),
            self.rows.eq(rows),
            costs.written.as_value().eq(Cat(*(rows[k] for k in range(1, self._layout.length)), self.newest)),
            costs.write.eq(valid[self.latency]),
            costs.write_at.eq(place[self.latency]),
        ]
        return m
