"""Numbers in a pipeline, with the operators that compute with them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Protocol

from amaranth.hdl import Cat, Value


class Registers(Protocol):
    """What a word asks of its `Pipeline`."""

    def constant(self, value: int, time: int) -> Word: ...
    def at(self, word: Word, time: int) -> Word: ...
    def aligned(self, *words: Word) -> tuple[Word, ...]: ...
    def within(self, word: Word, minimum: int, maximum: int) -> Word: ...
    def shifted(self, word: Word, bits: int) -> Word: ...
    def result(self, value: Value, minimum: int, maximum: int, time: int, name: str) -> Word: ...
    def add(self, a: Word, b: Word) -> Word: ...
    def subtract(self, a: Word, b: Word) -> Word: ...
    def multiply(self, a: Word, b: Word) -> Word: ...


@dataclass(frozen=True)
class Word:
    """A number in a pipeline: its signal, the range it can take, its time in operations, and its name.

    ``a + b``, ``a - b`` and the comparisons ``<``, ``<=``, ``>``, ``>=`` take one operation, on a carry
    chain; ``a * b`` takes a multiplier and its registers. Either operand may be an integer. What only
    rearranges bits takes no operation: ``a << bits``, ``a[k]``, ``a[low:high]``, `negative`, `inverted`,
    and ``&``, ``|``, ``^`` and ``~`` of flags, which are words of 0 and 1. Operands of different times are
    aligned. Registers are named after the words that they hold.
    """

    value: Value
    minimum: int
    maximum: int
    time: int
    name: str = field(compare=False)
    pipeline: Registers = field(compare=False, repr=False)

    def __len__(self) -> int:
        return len(self.value)

    def at(self, time: int) -> Word:
        """The word, delayed until ``time``."""
        return self.pipeline.at(self, time)

    def named(self, name: str) -> Word:
        """The word, by another name."""
        return replace(self, name=name)

    def within(self, minimum: int, maximum: int) -> Word:
        """The word, known by other reasoning to stay within a narrower range: wires only."""
        return self.pipeline.within(self, minimum, maximum)

    def __add__(self, other: Word | int) -> Word:
        return self.pipeline.add(self, self._operand(other))

    def __sub__(self, other: Word | int) -> Word:
        return self.pipeline.subtract(self, self._operand(other))

    def __mul__(self, other: Word) -> Word:
        return self.pipeline.multiply(self, other)

    def __lshift__(self, bits: int) -> Word:
        return self.pipeline.shifted(self, bits)

    def __gt__(self, other: Word | int) -> Word:
        return ~(self <= other)

    def __le__(self, other: Word | int) -> Word:
        # The sign of a - b - 1: b's complement needs no carry.
        return (self + self._operand(other).inverted).negative

    def __lt__(self, other: Word | int) -> Word:
        return self._operand(other) > self

    def __ge__(self, other: Word | int) -> Word:
        return self._operand(other) <= self

    @property
    def negative(self) -> Word:
        """Whether a word whose range goes below 0 is negative."""
        return self[len(self) - 1].named(f"{self.name}_negative")

    @property
    def inverted(self) -> Word:
        """The one's complement, ``-word - 1``: ``a + b.inverted`` is ``a - b - 1``."""
        value = self.value if self.value.shape().signed else Cat(self.value, 0).as_signed()
        return replace(self, value=~value, minimum=-self.maximum - 1, maximum=-self.minimum - 1)

    def __getitem__(self, bits: int | slice) -> Word:
        """A bit, or a range of bits without a sign."""
        value = self.value[bits]
        name = f"{self.name}_{bits}" if isinstance(bits, int) else self.name
        return self._wire(value, (1 << len(value)) - 1, name)

    def __and__(self, other: Word) -> Word:
        a, b = self._flags(other)
        return a._wire(a.value & b.value, 1, f"{a.name}_and_{b.name}")

    def __or__(self, other: Word) -> Word:
        a, b = self._flags(other)
        return a._wire(a.value | b.value, 1, f"{a.name}_or_{b.name}")

    def __xor__(self, other: Word) -> Word:
        a, b = self._flags(other)
        return a._wire(a.value ^ b.value, 1, f"{a.name}_xor_{b.name}")

    def __invert__(self) -> Word:
        (a,) = self._flags()
        return a._wire(~a.value, 1, f"not_{a.name}")

    def _wire(self, value: Value, maximum: int, name: str) -> Word:
        return Word(value, 0, maximum, self.time, name, self.pipeline)

    def _operand(self, other: Word | int) -> Word:
        return other if isinstance(other, Word) else self.pipeline.constant(other, self.time)

    def _flags(self, *others: Word) -> tuple[Word, ...]:
        for word in (self, *others):
            if len(word) != 1 or word.minimum < 0:
                raise TypeError(f"logic is for words of 0 and 1, not for {word.minimum} .. {word.maximum}")
        return self.pipeline.aligned(self, *others)
