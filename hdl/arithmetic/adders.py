"""Sums that share a carry chain."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from amaranth.hdl import Cat, Const, Shape, Value

from softdepth.hdl.arithmetic.wires import wire
from softdepth.hdl.arithmetic.word import Word

CHAIN_BITS = 40
"""Longest carry chain that sums are joined into."""


@dataclass(frozen=True)
class Field:
    """One of several sums that share an adder: ``a + b + carry``, none of them negative."""

    a: Word
    b: Word
    carry: Word | None = None

    @property
    def bits(self) -> int:
        """Bits of the words, and one above for the carry."""
        return max(len(self.a.value), len(self.b.value)) + 1


def add_fields(fields: Sequence[Field]) -> list[Word]:
    """``a + b + carry`` of every field in one operation, with few adders for all of them.

    The fields lie side by side. Below each is a bit in which both operands are the carry that it is
    given: that bit's sum is the carry out of the field below. So a carry in costs nothing extra, and only
    the ends of a chain are wasted.
    """
    results: list[Word] = []
    chain: list[Field] = []
    for field in fields:
        if chain and sum(f.bits for f in [*chain, field]) > CHAIN_BITS:
            results += _chain(chain)
            chain = []
        chain.append(field)
    return results + _chain(chain)


def add_with_carry(a: Word, b: Word, carry: Word | int, minimum: int, maximum: int) -> Word:
    """``a + b + carry``, of any sign, known to lie within a range. One operation.

    The carry enters as a bit below both words.
    """
    pipeline = a.pipeline
    if isinstance(carry, int):
        carry = pipeline.constant(carry, a.time)
    a, b, carry = pipeline.aligned(a, b, carry)
    bits = Shape.cast(range(minimum, maximum + 1)).width
    total = (Cat(carry.value, _extended(a.value, bits)) + Cat(carry.value, _extended(b.value, bits)))[1:]
    value = total[:bits].as_signed() if minimum < 0 else total[:bits]
    return pipeline.result(value, minimum, maximum, a.time, "sum")


def magnitude(word: Word, negative: Word, bits: int, maximum: int) -> Word:
    """``|word|``, from its low bits and its sign. One operation.

    The one's complement of a negative word is its magnitude less 1, and the carry is that 1.
    """
    return _folded(word, negative, bits, negative, maximum)


def distance(less_1: Word, negative: Word, bits: int, maximum: int) -> Word:
    """``|a - b|``, from the low bits and the sign of ``a - b - 1``. One operation.

    The one's complement of a negative ``a - b - 1`` is ``b - a`` itself; otherwise the carry is the 1 that is
    missing. So neither the difference nor its magnitude needs more than one adder.
    """
    return _folded(less_1, negative, bits, ~negative, maximum)


def _folded(word: Word, negative: Word, bits: int, carry: Word, maximum: int) -> Word:
    """The low bits, or their complement where the word is negative, and a carry."""

    def fold(value: Value, sign: Value) -> Value:
        return value[:bits] ^ sign.replicate(bits)

    folded = wire(fold, word, negative, minimum=0, maximum=2**bits - 1)
    return add_with_carry(folded, word.pipeline.constant(0, folded.time), carry, 0, maximum)


def _chain(fields: Sequence[Field]) -> list[Word]:
    pipeline = fields[0].a.pipeline
    time = max(w.time for f in fields for w in (f.a, f.b, f.carry) if w is not None)
    a: list[Value] = []
    b: list[Value] = []
    starts: list[int] = []
    for field in fields:
        if a or field.carry is not None:
            carry = pipeline.at(field.carry, time).value if field.carry is not None else Const(0, 1)
            a.append(carry)
            b.append(carry)
        starts.append(len(Cat(a)))
        a.append(_extended(pipeline.at(field.a, time).value, field.bits - 1))
        b.append(_extended(pipeline.at(field.b, time).value, field.bits - 1))
    bits = len(Cat(a)) + 1
    total = pipeline.result(Cat(a) + Cat(b), 0, 2**bits - 1, time, "sums")
    results = []
    for field, start in zip(fields, starts, strict=True):
        maximum = field.a.maximum + field.b.maximum + (field.carry is not None)
        value = total.value[start : start + min(field.bits, maximum.bit_length())]
        results.append(replace(total, value=value, maximum=maximum))
    return results


def _extended(value: Value, bits: int) -> Value:
    """A value's lowest ``bits`` bits, its sign repeated above."""
    missing = bits - len(value)
    if missing <= 0:
        return value[:bits]
    return Cat(value, value[-1].replicate(missing) if value.shape().signed else Const(0, missing))
