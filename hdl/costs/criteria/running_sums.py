"""Running sums down columns, in block RAM: each adds a row and drops one."""

from collections.abc import Sequence

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.packed_memory import PackedMemory


class RunningSums(wiring.Component):
    """Several sums at the same place: ``sum += new - old``, starting from 0 on a frame's first row.

    What the memory held before a frame does not matter. One place a clock; the same place may come again 6
    clocks later at the earliest.

    Parameters
    ----------
    maxima : the largest value of each sum.
    news : the largest of each value that is added or taken away.
    places : of the longest line.

    Members
    -------
    valid, place, begins : a place is looked up; it is on a frame's first row.
    outside : there is no such column; the sums are 0, nothing is stored, and ``place`` does not matter.
    new, old : what comes in and what goes, `ahead` clocks after its place.
    o : the sums, `latency` clocks after the place.
    """

    ahead = 3
    latency = 5

    def __init__(self, maxima: Sequence[int], news: Sequence[int], places: int) -> None:
        self._sums = data.StructLayout({str(k): range(high + 1) for k, high in enumerate(maxima)})
        self._news = data.StructLayout({str(k): range(high + 1) for k, high in enumerate(news)})
        self._places = places
        super().__init__(
            {
                "valid": In(1),
                "place": In(range(places)),
                "begins": In(1),
                "outside": In(1),
                "new": In(self._news),
                "old": In(self._news),
                "o": Out(self._sums),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.memory = memory = PackedMemory(unsigned(self._sums.size), self._places)
        stored = Signal()
        m.d.comb += stored.eq(self.valid & ~self.outside)
        occurs = travelling(m, stored, 5, "stored")
        place = [self.place]
        begins = [self.begins]
        outside = [self.outside]
        for clock in range(1, 6):
            for name, line in (("place", place), ("begins", begins), ("outside", outside)):
                line.append(Signal.like(line[-1], name=f"{name}_{clock}", reset_less=True))
                m.d.sync += line[-1].eq(line[-2])
        # Clock 1: the memory is read. Clock 3: its word, from registers. Clock 4: the word and its change.
        read = Signal(self._sums)
        m.d.comb += [
            memory.read.eq(occurs[1]),
            memory.read_at.eq(place[1]),
            read.as_value().eq(memory.data),
        ]
        total = Signal(self._sums, reset_less=True)
        for name in self._sums.members:
            change = Signal((self.new[name] - self.old[name]).shape(), name=f"change_{name}", reset_less=True)
            before = Signal.like(read[name], name=f"before_{name}", reset_less=True)
            m.d.sync += [
                change.eq(self.new[name] - self.old[name]),
                before.eq(Mux(begins[3], 0, read[name])),
                total[name].eq(Mux(outside[4], 0, before + change)),
            ]
        m.d.comb += [
            self.o.eq(total),
            memory.write.eq(occurs[5]),
            memory.write_at.eq(place[5]),
            memory.written.eq(total),
        ]
        return m
