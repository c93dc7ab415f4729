"""A memory of wide words that take several clocks to read and to write, and so fewer block RAMs."""

from amaranth.hdl import Cat, Const, Module, Mux, ShapeLike, Signal, Value, unsigned
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.packed_memory import PackedMemory

MOST_CLOCKS = 2
"""Parts of a word, at most."""


def clocks_of(steps: int) -> int:
    """The ``clocks`` of a memory in a core that takes ``steps`` clocks a pixel."""
    return 1 << min(steps, MOST_CLOCKS).bit_length() - 1


class FoldedMemory(wiring.Component):
    """One write and one read port for words that come at most one every ``clocks`` clocks.

    A word lies in as many parts, one behind the other: the memory is deeper and narrower, and block RAM
    wastes less on that shape. 1280 words of 110 bits take ten blocks of 18 kbit, and nine in halves.
    Addresses and the blocks' outputs are registered. A word must not be read until it is written, which
    takes ``clocks`` clocks from the one after ``write``.

    Parameters
    ----------
    shape : of a word.
    depth : words.
    clocks : the fewest from one word to the next: 1, 2, 4, ...

    Members
    -------
    read, read_at, data : ``data`` is the word at ``read_at``, `latency` clocks after ``read``, for one clock.
    write, write_at, written : a word to be stored; it must be held for the ``clocks`` clocks that follow.
    """

    def __init__(self, shape: ShapeLike, depth: int, clocks: int = 1) -> None:
        if clocks < 1 or clocks & (clocks - 1):
            raise ValueError(f"a word takes {clocks} clocks, but a memory is folded into 1, 2, 4, ... parts")
        self._depth, self._clocks = depth, clocks
        self.latency = self.latency_of(clocks)
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

    @staticmethod
    def latency_of(clocks: int) -> int:
        """Clocks from an address to its word."""
        return clocks + PackedMemory.latency

    def elaborate(self, platform: object) -> Module:
        m = Module()
        clocks = self._clocks
        word, data = Value.cast(self.written), Value.cast(self.data)
        part = -(-len(word) // clocks)
        m.submodules.memory = memory = PackedMemory(unsigned(part), self._depth * clocks)
        turns, at = self._addressed(m, self.read, self.read_at, "read")
        m.d.comb += [memory.read.eq(Cat(*turns).any()), memory.read_at.eq(at)]

        found = [Value.cast(memory.data)]
        for k in range(clocks - 1):
            found.append(Signal(part, name=f"found_{k}", reset_less=True))
            m.d.sync += found[-1].eq(found[-2])
        m.d.comb += data.eq(Cat(*reversed(found)))

        turns, at = self._addressed(m, self.write, self.write_at, "write")
        padded = Cat(word, Const(0, part * clocks - len(word)))
        chosen: Value = padded[:part]
        for k in range(1, clocks):
            chosen = Mux(turns[k], padded[k * part : (k + 1) * part], chosen)
        m.d.comb += [
            memory.write.eq(Cat(*turns).any()),
            memory.write_at.eq(at),
            memory.written.eq(chosen),
        ]
        return m

    def _addressed(self, m: Module, happens: Signal, place: Signal, name: str) -> tuple[list[Signal], Value]:
        """Which part's turn it is, from the clock after ``happens`` on, and where that part lies."""
        turns = travelling(m, happens, self._clocks, f"{name}s")[1:]
        held = Signal.like(place, name=f"{name}_place", reset_less=True)
        with m.If(happens):
            m.d.sync += held.eq(place)
        bits = (self._clocks - 1).bit_length()
        number = [Cat(turns[k] for k in range(self._clocks) if k >> bit & 1).any() for bit in range(bits)]
        return turns, Cat(*number, held)
