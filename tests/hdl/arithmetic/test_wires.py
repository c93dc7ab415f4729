"""Wires: choices, masks and complements keep values, ranges and times."""

from collections.abc import Callable, Sequence
from itertools import product

import pytest
from amaranth.hdl import Value

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.wires import choose, flag, inverted_if, wire
from softdepth.hdl.arithmetic.word import Word
from tests.support.arithmetic import Arithmetic, Range
from tests.support.simulation import piped

RANGES: list[Range] = [(0, 7), (0, 1), (-3, 5), (-8, -2), (2, 6), (0, 0)]


def check(
    ranges: Sequence[Range],
    build: Callable[[Pipeline, Sequence[Word]], Word],
    function: Callable[..., int],
    expected: Range,
    operations: int = 0,
) -> None:
    """Compare with a function over all inputs. The range must hold them, and be the ``expected`` one."""
    inputs = list(product(*(range(low, high + 1) for low, high in ranges)))
    dut = Arithmetic(ranges, operations, build)
    got = piped(dut, [{"i": {f"a{k}": v for k, v in enumerate(values)}} for values in inputs])
    assert got == [function(*values) for values in inputs]
    word = dut.word
    assert (word.minimum, word.maximum) == expected
    assert word.minimum <= min(got) <= max(got) <= word.maximum
    assert word.time == operations


@pytest.mark.parametrize(("a", "b"), list(product(RANGES, repeat=2)))
def test_choose(a: Range, b: Range) -> None:
    check(
        [(0, 1), a, b],
        lambda p, w: choose(*w),
        lambda condition, x, y: x if condition else y,
        (min(a[0], b[0]), max(a[1], b[1])),
    )


@pytest.mark.parametrize("a", RANGES)
def test_choose_beside_a_constant(a: Range) -> None:
    """A word where the condition holds, or where it does not, and else 0."""
    expected = (min(a[0], 0), max(a[1], 0))
    check([(0, 1), a], lambda p, w: choose(w[0], w[1], 0), lambda c, x: x if c else 0, expected)
    check([(0, 1), a], lambda p, w: choose(w[0], 0, w[1]), lambda c, x: 0 if c else x, expected)


@pytest.mark.parametrize("a", RANGES)
def test_inverted(a: Range) -> None:
    check([a], lambda p, w: w[0].inverted, lambda x: ~x, (~a[1], ~a[0]))


@pytest.mark.parametrize("a", [r for r in RANGES if r[0] >= 0])
def test_inverted_if(a: Range) -> None:
    check(
        [(0, 1), a],
        lambda p, w: inverted_if(*w),
        lambda condition, x: ~x if condition else x,
        (~a[1], a[1]),
    )


@pytest.mark.parametrize("bits", [(0, 7), (-3, 5)])
def test_flag(bits: Range) -> None:
    def is_odd(a: Value, b: Value) -> Value:
        return a[0] ^ b[0]

    check([bits, (0, 3)], lambda p, w: flag(is_odd, *w), lambda a, b: (a + b) % 2, (0, 1))


def test_operands_of_different_times_are_aligned() -> None:
    """The condition is as old as the sum that it chooses, and so is the other choice."""

    def build(p: Pipeline, w: Sequence[Word]) -> Word:
        late = p.add(p.add(p.add(w[1], w[2]), w[1]), w[2])
        return choose(w[0], late, w[2])

    check([(0, 1), (0, 7), (-3, 5)], build, lambda c, a, b: 2 * a + 2 * b if c else b, (-6, 24), 3)


def test_a_wire_takes_the_range_that_it_is_told() -> None:
    check(
        [(0, 7)],
        lambda p, w: wire(lambda v: v | 8, w[0], minimum=8, maximum=15),
        lambda a: a + 8,
        (8, 15),
    )
