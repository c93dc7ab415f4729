"""Pipelined arithmetic that keeps its own books: widths and clocks."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

from amaranth.hdl import Array, Const, Module, Mux, Shape, Signal, Value, ValueLike

from softdepth.hdl.arithmetic.word import Word

T = TypeVar("T")

SMALL_TABLE = 128
"""Tables up to this length are selected from entry by entry, which is smaller but slow to elaborate."""


LEVELS = 2
"""Operations between two registers."""


class Pipeline:
    """Builds pipelined arithmetic into a module.

    Time is counted in operations, of which ``levels`` fit between two registers: an operation is one
    carry chain, or a table of a few levels. Operands of different times are aligned by registers,
    widths follow from the ranges. The registers run freely and have no reset: valid bits elsewhere say which
    clocks matter.
    """

    def __init__(self, m: Module, levels: int = LEVELS) -> None:
        self._m = m
        self._levels = levels
        # Keyed by identity, so the source is kept alive beside its register.
        self._delayed: dict[tuple[int, int], tuple[Value, Signal]] = {}

    def input(self, value: ValueLike, maximum: int, name: str, *, minimum: int = 0, time: int = 0) -> Word:
        """A word that enters the pipeline at ``time``; timing reports call what delays it ``name_late_1``."""
        return Word(Value.cast(value), minimum, maximum, time, name, self)

    def constant(self, value: int, time: int) -> Word:
        """A constant, of a ``time`` like that of the words beside it."""
        shape = _shape(min(value, 0), max(value, 1))
        return Word(Const(value, shape), value, value, time, str(value), self)

    def result(self, value: ValueLike, minimum: int, maximum: int, time: int, name: str) -> Word:
        """The word ``value``, an operation on words of ``time``; timing reports call it ``name``."""
        if (time + 1) % self._levels == 0:
            register = self._register(value, minimum, maximum, name)
            return Word(register, minimum, maximum, time + 1, name, self)
        wire = Signal(_shape(minimum, maximum), name=name)
        self._m.d.comb += wire.eq(value)
        return Word(wire, minimum, maximum, time + 1, name, self)

    def at(self, word: Word, time: int) -> Word:
        """``word`` delayed until ``time``."""
        if time < word.time:
            raise ValueError(f"a word of time {word.time} is not there at time {time}")
        value, name = word.value, word.name
        if isinstance(value, Const):
            return replace(word, time=time)
        for clock in range(word.time // self._levels, time // self._levels):
            key = (id(value), clock)
            if key not in self._delayed:
                late = self._register(value, word.minimum, word.maximum, _late(name))
                self._delayed[key] = (value, late)
            value = self._delayed[key][1]
            name = value.name
        return replace(word, value=value, time=time, name=name)

    def clock(self, word: Word) -> int:
        """The clock in which ``word`` is there."""
        return word.time // self._levels

    def _register(self, value: ValueLike, minimum: int, maximum: int, name: str) -> Signal:
        signal = Signal(_shape(minimum, maximum), name=name, reset_less=True)
        self._m.d.sync += signal.eq(value)
        return signal

    def aligned(self, *words: Word) -> tuple[Word, ...]:
        """The words, all delayed to the latest of their clocks."""
        time = max(word.time for word in words)
        return tuple(self.at(word, time) for word in words)

    def add(self, a: Word, b: Word) -> Word:
        """``a + b``."""
        a, b = self.aligned(a, b)
        return self.result(a.value + b.value, a.minimum + b.minimum, a.maximum + b.maximum, a.time, "sum")

    def max(self, a: Word, b: Word) -> Word:
        """The larger of two words."""
        a, b = self.aligned(a, b)
        larger = Mux(a.value > b.value, a.value, b.value)
        return self.result(larger, max(a.minimum, b.minimum), max(a.maximum, b.maximum), a.time, "larger")

    def subtract(self, a: Word, b: Word) -> Word:
        """``a - b``."""
        a, b = self.aligned(a, b)
        return self.result(
            a.value - b.value, a.minimum - b.maximum, a.maximum - b.minimum, a.time, "difference"
        )

    def multiply(self, a: Word, b: Word) -> Word:
        """``a * b`` of two words that are never negative, in two clocks from registers to a register.

        The multipliers of an FPGA are far from most logic and have registers of their own: one clock is for
        the way there, one for the product. If the operands leave part of a clock unused, it is lost.
        """
        there = (clocks(max(a.time, b.time), self._levels) + 1) * self._levels
        a, b = self.at(a, there), self.at(b, there)
        highest = a.maximum * b.maximum
        product = self._register(a.value * b.value, 0, highest, "product")
        return Word(product, 0, highest, there + self._levels, "product", self)

    def rounded(self, word: Word, bits: int) -> Word:
        """``word / 2**bits``, rounded half up."""
        half = 1 << bits >> 1
        return self.result(
            (word.value + half) >> bits,
            (word.minimum + half) >> bits,
            (word.maximum + half) >> bits,
            word.time,
            "rounded",
        )

    def lookup(self, table: Sequence[int], word: Word) -> Word:
        """``table[word]``; every larger index gets the last entry."""
        low, high = min(table), max(table)
        entries = [Const(value, _shape(low, high)) for value in table]
        if len(table) > SMALL_TABLE:
            starts = [0, *(i for i in range(1, len(table)) if table[i] != table[i - 1])]
            return self.result(_search(word.value, entries, starts), low, high, word.time, "entry")
        beyond = word.value >= len(table) - 1
        found = Mux(beyond, entries[-1], Array(entries)[word.value])
        return self.result(found, low, high, word.time, "entry")

    def within(self, word: Word, minimum: int, maximum: int) -> Word:
        """``word``, known by other reasoning to stay within a narrower range: wires only."""
        shape = _shape(minimum, maximum)
        bits = word.value[: shape.width]
        value = bits.as_signed() if shape.signed else bits
        return replace(word, value=value, minimum=minimum, maximum=maximum)

    def shifted(self, word: Word, bits: int) -> Word:
        """``word * 2**bits``: wires only."""
        low, high = word.minimum << bits, word.maximum << bits
        return replace(word, value=word.value << bits, minimum=low, maximum=high)

    def tree(self, operation: Callable[[T, T], T], words: Sequence[T]) -> T:
        """Reduce ``words`` with a balanced tree, in ``tree_operations(len(words))`` operations."""
        level = list(words)
        while len(level) > 1:
            paired = [operation(a, b) for a, b in zip(level[::2], level[1::2], strict=False)]
            level = [*paired, *level[len(paired) * 2 :]]
        return level[0]

    def sum(self, words: Sequence[Word]) -> Word:
        """The sum of ``words`` by a balanced adder tree."""
        return self.tree(self.add, words)


def clocks(operations: int, levels: int = LEVELS) -> int:
    """Clocks that so many successive operations take."""
    return -(-operations // levels)


def start(operations: int, levels: int = LEVELS) -> int:
    """When a row of operations must begin so that the last one ends in a register."""
    return -operations % levels


def travelling(m: Module, bit: Signal, clocks: int, name: str, *, since: int = 0) -> list[Signal]:
    """``bit`` now and after each of ``clocks`` clocks, reset to 0: it says which data are valid.

    The registers are called ``name_T``, T the clock counted from ``since``.
    """
    bits = [bit]
    for time in range(since + 1, since + clocks + 1):
        bits.append(Signal(name=f"{name}_{time}"))
        m.d.sync += bits[-1].eq(bits[-2])
    return bits


def tree_operations(words: int) -> int:
    """Operations in a row that `Pipeline.tree` takes for so many words."""
    return (words - 1).bit_length()


def _search(index: Value, entries: Sequence[Const], starts: Sequence[int]) -> Value:
    """Binary search for the run of equal entries containing ``index``, by where each run starts."""
    if len(starts) == 1:
        return entries[starts[0]]
    half = len(starts) // 2
    upper, lower = (_search(index, entries, part) for part in (starts[half:], starts[:half]))
    return Mux(index >= starts[half], upper, lower)


def _late(name: str) -> str:
    """The name of a word one clock later: its own, with the clocks since then appended."""
    known, _, clocks = name.rpartition("_late_")
    return f"{known}_late_{int(clocks) + 1}" if known and clocks.isdigit() else f"{name}_late_1"


def _shape(minimum: int, maximum: int) -> Shape:
    return Shape.cast(range(minimum, maximum + 1))
