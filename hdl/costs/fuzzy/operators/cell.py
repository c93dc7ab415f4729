"""Theta over the memberships of a cell, where those of each criterion complement each other."""

from dataclasses import dataclass
from typing import Protocol

from amaranth.hdl import Cat, Const, Value

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose, wire
from softdepth.hdl.arithmetic.word import Word

Corners = tuple[Word, Word, Word]


@dataclass(frozen=True)
class Position:
    """Criterion 1 in its cell: the memberships of the outer label and of the middle one; they sum to one."""

    outer: Word
    middle: Word


class CellOperator(Protocol):
    """Theta in two halves, each for all rules of a cell that share it."""

    corner_operations: int
    """Operations in a row of `corners`."""
    fire_operations: int
    """Operations in a row of `fire`."""

    def corners(self, pipeline: Pipeline, b: Word, c: Word) -> Corners:
        """The pairs of criteria 2 and 3, by the number of their upper labels: 0, 1 and 2.

        `b` and `c` are the upper labels' memberships, ``0 .. one``. There are two pairs of one upper
        label: the larger of them.
        """
        ...

    def fire(self, pipeline: Pipeline, a: Position, pair: Word) -> tuple[Word, Word]:
        """The firing strengths of a pair with criterion 1's outer label, and with its middle one."""
        ...


def complement(word: Word, one: int) -> Word:
    """``one - 1 - word`` of a word from above ``-one`` up to `one - 1`, or from 0 up to `one`. Wires only."""
    bits = one.bit_length() - 1
    low, high = one - 1 - word.maximum, one - 1 - word.minimum

    def invert(v: Value) -> Value:
        top = Cat(v, Const(0, 1))[bits] if word.minimum >= 0 else v[-1]
        inverse = Cat(~Cat(v, Const(0, bits))[:bits], top)
        return inverse.as_signed() if low < 0 else inverse

    return wire(invert, word, minimum=low, maximum=high)


def order(b: Word, c: Word) -> tuple[Word, Word, Word]:
    """``b - c - 1``, one operation later, and then the smaller and the larger of both."""
    difference = b + c.inverted
    c_larger = difference.negative
    return difference, choose(c_larger, b, c), choose(c_larger, c, b)


def excess(a: Word, b: Word, one: int) -> Word:
    """``a + b - one``, where `a` is a membership."""
    bits = one.bit_length() - 1
    less_one = wire(lambda v: Cat(v[:bits], ~v[bits]).as_signed(), a, minimum=-one, maximum=0)
    return less_one + b
