"""A memory in as few block RAMs as its depth allows."""

from functools import cache

from amaranth.hdl import Cat, Const, Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.sliced_memory import SLICES

SEGMENTS = {depth: width for depth, width in SLICES.items() if depth <= 2048}
"""The depths that a memory is composed of, and how wide a block of each depth is."""


class PackedMemory(wiring.Component):
    """One write and one read port, like `SlicedMemory`, for depths that are far from a power of two.

    The depth is made of segments, each as deep as blocks of one width: 2560 words of 9 bits are 2048 of 9,
    and 512 that share a block with three others. Each block has an output register, and behind these one
    multiplexer per bit chooses between segments. A word must not be read in the clock in which it is
    written.

    Parameters
    ----------
    shape : of a word.
    depth : words.

    Members
    -------
    read, read_at, data : ``data`` is the word at ``read_at``, `latency` clocks after ``read``, for one clock.
    write, write_at, written : a word to be stored.
    """

    latency = 2

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
        segments = segments_of(len(word), self._depth)
        found: Value | None = None
        base = self._depth if not segments else 0
        for deep in segments:
            used = min(deep, self._depth - base)
            is_read = self._within(self.read_at, base, used)
            is_written = self._within(self.write_at, base, used)
            bits = []
            for low in range(0, len(word), SEGMENTS[deep]):
                part = word[low : low + SEGMENTS[deep]]
                m.submodules[f"slice_{base}_{low}"] = memory = Memory(shape=len(part), depth=used, init=[])
                read = memory.read_port()
                write = memory.write_port()
                m.d.comb += [
                    read.en.eq(self.read),
                    read.addr.eq(self.read_at - base if base % deep else self.read_at[: len(read.addr)]),
                    write.en.eq(self.write & is_written),
                    write.addr.eq(self.write_at - base if base % deep else self.write_at[: len(write.addr)]),
                    write.data.eq(part),
                ]
                behind = Signal(len(part), name=f"behind_{base}_{low}", reset_less=True)
                m.d.sync += behind.eq(read.data)
                bits.append(behind)
            chosen = Signal(name=f"chosen_{base}", reset_less=True)
            with m.If(self.read):
                m.d.sync += chosen.eq(is_read)
            chosen_late = Signal(name=f"chosen_late_{base}", reset_less=True)
            m.d.sync += chosen_late.eq(chosen)
            found = Cat(*bits) if found is None else Mux(chosen_late, Cat(*bits), found)
            base += used
        if found is not None:
            m.d.comb += data.eq(found)
        return m

    def _within(self, address: Value, base: int, used: int) -> Value:
        """Whether an address lies in a segment; what always holds is not compared: readers warn of that."""
        least = address >= base if base else Const(1)
        return least & (address < base + used) if base + used < self._depth else least


def blocks(bits: int, depth: int) -> int:
    """Block RAMs of 18 kbit that a `PackedMemory` takes."""
    return sum(-(-bits // SEGMENTS[deep]) for deep in segments_of(bits, depth))


@cache
def segments_of(bits: int, depth: int) -> tuple[int, ...]:
    """Depths of the segments that take the fewest blocks, deepest first; of equals, the fewest segments."""
    deepest = max(SEGMENTS)
    whole, left = divmod(depth, deepest)
    choices: list[tuple[int, ...]] = []

    def extend(chosen: tuple[int, ...], left: int) -> None:
        if left <= 0:
            choices.append(chosen)
            return
        for deep in sorted(SEGMENTS, reverse=True):
            if not chosen or deep < chosen[-1]:
                extend((*chosen, deep), left - deep)

    extend((), left)
    fits = [c for c in choices if sum(c) >= left]
    best = min(fits, key=lambda c: (sum(-(-bits // SEGMENTS[d]) for d in c), len(c)))
    return (*(deepest,) * whole, *best)
