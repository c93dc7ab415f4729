"""Pipeline: ranges, widths, alignment and operations a clock, with the extremes of every range."""

import itertools
import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from random import Random
from typing import Any

import pytest
from amaranth.hdl import Const, Module, Shape, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start, travelling, tree_operations
from softdepth.hdl.arithmetic.word import Word
from tests.support.arithmetic import Arithmetic, Range
from tests.support.simulation import observe, piped


def check(
    ranges: Sequence[Range],
    operations: int | Callable[[int], int],
    build: Callable[[Pipeline, Sequence[Word]], Word],
    function: Callable[..., int],
    *,
    lowest: int | None = None,
) -> None:
    """Compare an expression with a function, at all extremes and at random, for 1 to 3 operations a clock.

    Its inputs change in every clock. Its range is what the function reaches, with ``lowest`` the minimum
    where that is a bound only. How many ``operations`` it takes may depend on how many a clock has.
    """
    random = Random(1)
    corners = list(itertools.islice(itertools.product(*ranges), 64))
    inputs = [*corners, *([random.randint(*r) for r in ranges] for _ in range(100))]
    inputs.append([low for low, _ in ranges])
    inputs.append([high for _, high in ranges])
    if len(ranges) == 2 and max(low for low, _ in ranges) <= min(high for _, high in ranges):
        inputs.append([max(low for low, _ in ranges)] * 2)  # equal operands
    random.shuffle(inputs)
    for levels in (1, 2, 3):
        wanted = operations if isinstance(operations, int) else operations(levels)
        dut = Arithmetic(ranges, wanted, build, levels=levels)
        got = piped(dut, [{"i": {f"a{k}": v for k, v in enumerate(values)}} for values in inputs])
        assert got == [function(*values) for values in inputs]
        assert dut.word.time == wanted
        assert dut.word.minimum == (min(got) if lowest is None else lowest) <= min(got)
        assert dut.word.maximum == max(got)
        assert dut.word.value.shape() == Shape.cast(range(dut.word.minimum, dut.word.maximum + 1))


RANGES: list[tuple[Range, Range]] = [
    ((0, 255), (0, 255)),
    ((0, 1), (0, 256)),
    ((-5, 3), (-128, 127)),
    ((-7, -2), (-3, -1)),
    ((-4, -1), (0, 9)),
    ((-300, 5), (0, 511)),
    ((0, 0), (-1, 1)),
]


@pytest.mark.parametrize(("a", "b"), RANGES)
def test_add(a: Range, b: Range) -> None:
    check([a, b], 1, lambda p, w: p.add(w[0], w[1]), lambda x, y: x + y)


@pytest.mark.parametrize(("a", "b"), RANGES)
def test_max(a: Range, b: Range) -> None:
    check([a, b], 1, lambda p, w: p.max(w[0], w[1]), max)


@pytest.mark.parametrize(("a", "b"), RANGES)
def test_subtract(a: Range, b: Range) -> None:
    check([a, b], 1, lambda p, w: p.subtract(w[0], w[1]), lambda x, y: x - y)


@pytest.mark.parametrize(
    ("a", "b"), [((0, 255), (0, 255)), ((0, 1), (0, 256)), ((0, 0), (0, 9)), ((3, 7), (0, 4))]
)
def test_multiply(a: Range, b: Range) -> None:
    """Two clocks of its own, from registers to a register."""
    check([a, b], lambda levels: 2 * levels, lambda p, w: p.multiply(w[0], w[1]), lambda x, y: x * y)
    sum_first = lambda p, w: p.multiply(p.add(w[0], w[1]), w[1])  # noqa: E731
    check([a, b], lambda levels: 3 * levels, sum_first, lambda x, y: (x + y) * y)


@pytest.mark.parametrize("bits", [0, 1, 2, 8])
@pytest.mark.parametrize("a", [(0, 65536), (0, 3), (-1000, 999), (-128, -1)])
def test_rounded_half_up(a: Range, bits: int) -> None:
    check(
        [a],
        1,
        lambda p, w: p.rounded(w[0], bits),
        lambda x: math.floor(Fraction(x, 2**bits) + Fraction(1, 2)),
    )


def test_rounded_at_every_half() -> None:
    dut = Arithmetic([(-12, 12)], 1, lambda p, w: p.rounded(w[0], 2))
    got = piped(dut, [{"i": {"a0": value}} for value in (-10, -6, -5, -2, -1, 2, 1, 6, 10)])
    assert got == [-2, -1, -1, 0, 0, 1, 0, 2, 3]


@pytest.mark.parametrize("table", [(5,), (-1, 0), (0, -6, 3), (7, 7, -8, 0), tuple(range(-3, 6)), (0,)])
@pytest.mark.parametrize("highest", [0, 1, 3, 4, 9, 40])
def test_lookup_within_and_beyond_the_table(table: tuple[int, ...], highest: int) -> None:
    """Every index of the word, which may be fewer than the table has or many more."""
    dut = Arithmetic([(0, highest)], 1, lambda p, w: p.lookup(table, w[0]))
    got = piped(dut, [{"i": {"a0": index}} for index in range(highest + 1)])
    assert got == [table[index] if index < len(table) else table[-1] for index in range(highest + 1)]
    assert (dut.word.minimum, dut.word.maximum, dut.word.time) == (min(table), max(table), 1)


@pytest.mark.parametrize("narrow", [(0, 7), (-3, 7), (-8, -1), (-1, 0), (0, 0)])
def test_within_takes_no_clock_and_loses_nothing(narrow: Range) -> None:
    dut = Arithmetic([(-20, 100)], 0, lambda p, w: p.within(w[0], *narrow))
    values = range(narrow[0], narrow[1] + 1)
    assert piped(dut, [{"i": {"a0": value}} for value in values]) == list(values)
    assert (dut.word.minimum, dut.word.maximum, dut.word.time) == (*narrow, 0)
    assert dut.word.value.shape() == Shape.cast(range(narrow[0], narrow[1] + 1))


@pytest.mark.parametrize("bits", [0, 1, 5])
@pytest.mark.parametrize("a", [(0, 255), (-9, 100), (-16, -1)])
def test_shifted_takes_no_clock(a: Range, bits: int) -> None:
    dut = Arithmetic([a], 0, lambda p, w: p.shifted(w[0], bits))
    values = list(range(a[0], a[1] + 1))
    assert piped(dut, [{"i": {"a0": v}} for v in values]) == [v * 2**bits for v in values]
    assert (dut.word.minimum, dut.word.maximum, dut.word.time) == (a[0] * 2**bits, a[1] * 2**bits, 0)


@pytest.mark.parametrize("count", range(1, 10))
def test_sum_of_any_number_of_words(count: int) -> None:
    ranges = [(-k, 255 + k) for k in range(count)]
    check(ranges, tree_operations(count), lambda p, w: p.sum(w), lambda *values: sum(values))


@pytest.mark.parametrize("count", [1, 2, 3, 5, 8])
def test_tree_of_maxima(count: int) -> None:
    ranges = [(-k, 20 - 3 * k) for k in range(count)]
    check(ranges, tree_operations(count), lambda p, w: p.tree(p.max, w), lambda *values: max(values))


@pytest.mark.parametrize(("count", "operations"), [(1, 0), (2, 1), (3, 2), (4, 2), (5, 3), (16, 4), (17, 5)])
def test_tree_operations(count: int, operations: int) -> None:
    assert tree_operations(count) == operations


def test_operands_of_different_times_are_aligned() -> None:
    def build(p: Pipeline, w: Sequence[Word]) -> Word:
        late = p.add(p.add(p.add(w[0], w[1]), w[2]), w[0])
        return p.max(p.add(late, w[1]), p.shifted(w[2], 2))

    check([(0, 15), (-8, 7), (0, 9)], 5, build, lambda a, b, c: max(2 * a + 2 * b + c, 4 * c))


@pytest.mark.parametrize("levels", [1, 2, 3])
@pytest.mark.parametrize("time", [0, 1, 2, 3, 5, 6])
def test_inputs_may_arrive_later(levels: int, time: int) -> None:
    """The second input is said to come some clocks after the first: it is paired with what came then."""

    def build(p: Pipeline, w: Sequence[Word]) -> Word:
        return p.add(w[0], p.input(w[1].value, w[1].maximum, "second", time=time))

    dut = Arithmetic([(0, 255), (0, 255)], time + 1, build, levels=levels)
    random = Random(3)
    first, second = ([random.getrandbits(8) for _ in range(30)] for _ in range(2))
    inputs: list[Any] = [{"i": {"a0": a, "a1": b}} for a, b in zip(first, second, strict=True)]
    later = time // levels
    got = piped(dut, inputs)[: 30 - later]
    assert got == [a + b for a, b in zip(first, second[later:], strict=False)]


@pytest.mark.parametrize("time", range(5))
def test_at_delays_and_never_looks_ahead(time: int) -> None:
    check([(-3, 12)], time, lambda p, w: p.at(w[0], time), lambda a: a)

    def early(p: Pipeline, w: Sequence[Word]) -> Word:
        word = p.input(w[0].value, 1, "given", time=3)
        assert p.at(word, 3) == word
        with pytest.raises(ValueError, match="time 3 is not there at time 2"):
            p.at(word, 2)
        return word

    piped(Arithmetic([(0, 1)], 3, early), [{}])


def test_a_constant_needs_no_registers() -> None:
    def build(p: Pipeline, w: Sequence[Word]) -> Word:
        constant = p.at(p.input(Const(5, 3), 5, "five", minimum=5), 4)
        assert isinstance(constant.value, Const)
        return p.add(p.at(w[0], 4), constant)

    check([(-3, 12)], 5, build, lambda a: a + 5)


@pytest.mark.parametrize("levels", [1, 2, 3])
@pytest.mark.parametrize("operations", range(8))
def test_operations_end_in_a_register_and_none_is_wasted(operations: int, levels: int) -> None:
    """Begun at `start`, so many operations end with a clock, in as few clocks as they fit."""
    begin = start(operations, levels)
    assert 0 <= begin < levels
    assert (begin + operations) % levels == 0
    assert clocks(operations, levels) == (begin + operations) // levels == math.ceil(operations / levels)


@pytest.mark.parametrize("count", [0, 1, 4])
def test_a_travelling_bit_is_reset(count: int) -> None:
    """It is there at once and after each clock up to the last; what is under way at a reset is lost."""

    class Travelling(wiring.Component):
        i: In(1)
        o: Out(count + 1)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            bit = Signal()
            m.d.comb += bit.eq(self.i)
            bits = travelling(m, bit, count, "bit", since=2)
            assert [b.name for b in bits[1:]] == [f"bit_{time}" for time in range(3, count + 3)]
            m.d.comb += [self.o[k].eq(b) for k, b in enumerate(bits)]
            assert not any(b.reset_less for b in bits)
            return m

    random = Random(count)
    sent = [random.getrandbits(1) for _ in range(40)]
    seen = observe(Travelling(), [{"i": bit} for bit in sent], "o")
    for clock, bits in enumerate(seen):
        expected = [sent[clock - k] if clock >= k else 0 for k in range(count + 1)]
        assert [bits >> k & 1 for k in range(count + 1)] == expected
