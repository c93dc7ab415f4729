"""A memory of wide words, cut into slices that block RAM holds without a multiplexer."""

from amaranth.hdl import Cat, Module, ShapeLike, Value
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

SLICES = {512: 36, 1024: 18, 2048: 9, 4096: 4, 8192: 2}
"""The width in bits of one block RAM (18 kbit, as on ECP5 and many others) at each depth."""


class SlicedMemory(wiring.Component):
    """One write and one read port. A word must not be read in the clock in which it is written.

    Left alone, synthesis builds a deep memory from shallow blocks and chooses among their outputs. Here,
    words are cut instead into slices narrow enough for a single block to be as deep as the memory: a few
    more blocks, and no logic in the read path. Slices are as equal as possible, so parts with blocks of
    another size lose little at their edges.

    Parameters
    ----------
    shape : of a word.
    depth : words.

    Members
    -------
    read, read_at, data : ``data`` is the word at ``read_at``, `latency` clocks after ``read``, and held.
    write, write_at, written : a word to be stored.
    """

    latency = 1

    def __init__(self, shape: ShapeLike, depth: int) -> None:
        self._depth = depth
        super().__init__(
            {
                "read": In(1),
                "read_at": In(range(depth)),
                "data": Out(shape),
                "write": In(1),
                "write_at": In(range(depth)),
                "written": In(shape),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        word, data = Value.cast(self.written), Value.cast(self.data)
        widest = next((bits for deep, bits in SLICES.items() if self._depth <= deep), 1)
        width = -(-len(word) // -(-len(word) // widest))
        parts = []
        for low in range(0, len(word), width):
            part = word[low : low + width]
            m.submodules[f"slice_{low}"] = memory = Memory(shape=len(part), depth=self._depth, init=[])
            read = memory.read_port()
            write = memory.write_port()
            m.d.comb += [
                read.en.eq(self.read),
                read.addr.eq(self.read_at),
                write.en.eq(self.write),
                write.addr.eq(self.write_at),
                write.data.eq(part),
            ]
            parts.append(read.data)
        m.d.comb += data.eq(Cat(*parts))
        return m
