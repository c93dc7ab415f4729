"""The last rows of a raster, column by column, in as few block RAMs as the clocks of a pixel allow."""

from collections.abc import Sequence

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.packed_memory import PackedMemory


class RowStack(wiring.Component):
    """Keeps the items of the rows above at every place, gives them out, and puts a new one on top.

    With two clocks a place, a word is half as wide and the memory twice as deep, a shape on which block RAM
    wastes less: half the bits of every item come in each of the two clocks, and are written back in the same
    order, moved up by one row. The same place may come again four places later at the earliest. Items from
    before the frame are stale.

    Parameters
    ----------
    groups : bits of an item, and how many rows of it are kept; several, for items of different age.
    places : of the longest line.
    clocks : the fewest from one place to the next, 1 or 2.

    Members
    -------
    valid, place : a column is looked up.
    items : what is put on top, one item of each group, `ahead` clocks later.
    o : for each group, the items that were there, newest first, `latency` clocks later, for one clock.
    """

    ahead = 4

    def __init__(self, groups: Sequence[tuple[int, int]], places: int, clocks: int) -> None:
        if clocks not in (1, 2):
            raise ValueError(f"a place takes {clocks} clocks, but a stack is built for 1 or 2")
        self._groups, self._places, self._clocks = list(groups), places, clocks
        self.latency = self.ahead + clocks - 1
        super().__init__(
            {
                "valid": In(1),
                "place": In(range(places)),
                "items": In(data.StructLayout({str(k): bits for k, (bits, _) in enumerate(groups)})),
                "o": Out(
                    data.StructLayout(
                        {
                            str(k): data.ArrayLayout(unsigned(bits), rows)
                            for k, (bits, rows) in enumerate(groups)
                        }
                    )
                ),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        clocks = self._clocks
        parts = [-(-bits // clocks) for bits, _ in self._groups]
        word = sum(part * rows for part, (_, rows) in zip(parts, self._groups, strict=True))
        m.submodules.memory = memory = PackedMemory(unsigned(word), self._places * clocks)
        happens = travelling(m, self.valid, self.latency, "valid")
        place = [
            Signal(range(self._places), name=f"place_{k}", reset_less=True) for k in range(1, self.ahead + 1)
        ]
        with m.If(self.valid):
            m.d.sync += place[0].eq(self.place)
        m.d.sync += [place[k + 1].eq(place[k]) for k in range(self.ahead - 1)]

        # Clock 1: the word, or its first half, is looked up. Clock 3: the blocks' registers. Clock 4: ours.
        found = Signal(word, reset_less=True)
        m.d.sync += found.eq(memory.data)
        items = [Cat(value, Const(0, part * clocks - len(value))) for value, part in self._values(parts)]
        if clocks == 1:
            new: list[Value] = items
            m.d.comb += [
                memory.read.eq(happens[1]),
                memory.read_at.eq(place[0]),
                memory.write.eq(happens[4]),
                memory.write_at.eq(place[3]),
            ]
            halves = [found]
        else:
            first = Signal(word, reset_less=True)
            waiting = [Signal(part, name=f"waiting_{k}", reset_less=True) for k, part in enumerate(parts)]
            held = Signal.like(place[3], name="place_held", reset_less=True)
            second = happens[5]
            m.d.sync += [
                first.eq(found),
                held.eq(place[3]),
                *(w.eq(item[part:]) for w, item, part in zip(waiting, items, parts, strict=True)),
            ]
            new = [Mux(second, w, item[:part]) for w, item, part in zip(waiting, items, parts, strict=True)]
            m.d.comb += [
                memory.read.eq(happens[1] | happens[2]),
                memory.read_at.eq(Cat(happens[2], place[0])),
                memory.write.eq(happens[4] | happens[5]),
                memory.write_at.eq(Cat(second, Mux(second, held, place[3]))),
            ]
            halves = [first, found]
        low = 0
        written: list[Value] = []
        for k, ((bits, rows), part) in enumerate(zip(self._groups, parts, strict=True)):
            high = low + part * rows
            written.append(Cat(new[k], found[low:high])[: part * rows])
            for row in range(rows):
                at = low + row * part
                whole = Cat(half[at : at + part] for half in halves)
                m.d.comb += self.o[str(k)][row].eq(whole[:bits])
            low = high
        m.d.comb += memory.written.eq(Cat(*written))
        return m

    def _values(self, parts: Sequence[int]) -> list[tuple[Value, int]]:
        return [(Value.cast(self.items[str(k)]), part) for k, part in enumerate(parts)]
