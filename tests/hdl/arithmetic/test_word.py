"""Operators on words: what they compute, in how many operations, and what they refuse."""

import operator
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import pytest

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.word import Word
from tests.support.arithmetic import Arithmetic, Range
from tests.support.simulation import piped

A: Range = (-4, 3)
B: Range = (0, 5)


def check(ranges: Sequence[Range], operations: int, function: Callable[..., Any]) -> Word:
    """The same expression of words and of numbers gives the same, over all inputs."""
    dut = Arithmetic(ranges, operations, lambda p, w: function(*w))
    inputs = list(product(*(range(low, high + 1) for low, high in ranges)))
    got = piped(dut, [{"i": {f"a{k}": v for k, v in enumerate(values)}} for values in inputs])
    assert got == [int(function(*values)) for values in inputs]
    assert dut.word.time == operations
    assert dut.word.minimum <= min(got) <= max(got) <= dut.word.maximum
    return dut.word


@pytest.mark.parametrize("name", ["add", "sub", "lt", "le", "gt", "ge"])
def test_an_operation_on_two_words_or_a_word_and_a_number(name: str) -> None:
    function = getattr(operator, name)
    check([A, B], 1, function)
    check([B, A], 1, function)
    check([A], 1, lambda a: function(a, 2))


def test_a_product_goes_through_the_multiplier() -> None:
    check([B, (0, 3)], 4, operator.mul)


def test_wires_take_no_operation() -> None:
    check([A], 0, lambda a: a << 2)
    dut = Arithmetic([A], 0, lambda p, w: w[0].negative)
    assert piped(dut, [{"i": {"a0": v}} for v in range(-4, 4)]) == [v < 0 for v in range(-4, 4)]
    dut = Arithmetic([B], 0, lambda p, w: w[0].inverted)
    assert piped(dut, [{"i": {"a0": v}} for v in range(6)]) == [~v for v in range(6)]
    dut = Arithmetic([B], 0, lambda p, w: w[0][1:])
    assert piped(dut, [{"i": {"a0": v}} for v in range(6)]) == [v >> 1 for v in range(6)]


@pytest.mark.parametrize("name", ["and_", "or_", "xor"])
def test_logic_of_flags_aligns_them(name: str) -> None:
    function = getattr(operator, name)
    check([(0, 1), (0, 1)], 0, function)
    check([(0, 1), A, A], 1, lambda flag, a, b: function(flag, a > b))


def test_not_of_a_flag() -> None:
    dut = Arithmetic([(0, 1)], 0, lambda p, w: ~w[0])
    assert piped(dut, [{"i": {"a0": v}} for v in (0, 1)]) == [1, 0]


@pytest.mark.parametrize("wrong", [lambda a, b: a & b, lambda a, b: ~a, lambda a, b: b | a], ids="&~|")
def test_logic_is_not_for_numbers(wrong: Callable[[Word, Word], Word]) -> None:
    def build(p: Pipeline, w: Sequence[Word]) -> Word:
        with pytest.raises(TypeError, match=r"words of 0 and 1, not for -4 \.\. 3"):
            wrong(w[0], w[1])
        return w[1]

    piped(Arithmetic([A, (0, 1)], 0, build), [{}])
