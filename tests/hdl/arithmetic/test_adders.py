"""Adders: sums that share a carry chain do not see each other, and carries come in where they should."""

import re
from itertools import product
from random import Random
from typing import Any

import pytest
from amaranth.back import rtlil
from amaranth.hdl import Const, Module, Shape
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.adders import CHAIN_BITS, Field, add_fields, add_with_carry, distance, magnitude
from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.word import Word
from tests.support.arithmetic import Arithmetic, Range
from tests.support.simulation import piped

Spec = tuple[int, int, bool]
"""A field: the largest values of its words, and whether it has a carry."""


class Fields(wiring.Component):
    """Several sums by `add_fields`, the first of them of words that come ``late`` operations later."""

    def __init__(self, specs: list[Spec], late: int = 0) -> None:
        self.specs = specs
        self.late = late
        self.latency = (late + 1) // 2
        words = {}
        sums = {}
        for k, (a, b, carry) in enumerate(specs):
            words |= {f"a{k}": range(a + 1), f"b{k}": range(b + 1), f"c{k}": range(1 + carry)}
            sums[f"s{k}"] = range(a + b + carry + 1)
        super().__init__({"i": In(data.StructLayout(words)), "o": Out(data.StructLayout(sums))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)

        def word(name: str, maximum: int) -> Word:
            return pipeline.input(self.i[name] if maximum else Const(0, 1), maximum, name)

        fields = []
        for k, (a, b, carry) in enumerate(self.specs):
            given = word(f"a{k}", a)
            if k == 0:
                for _ in range(self.late):
                    given = pipeline.add(given, pipeline.input(Const(0, 1), 0, "none", time=given.time))
            fields.append(Field(given, word(f"b{k}", b), word(f"c{k}", 1) if carry else None))
        for k, (total, (a, b, carry)) in enumerate(zip(add_fields(fields), self.specs, strict=True)):
            assert total.time in (1, self.late + 1)  # a chain waits for its own words only
            assert (total.minimum, total.maximum) == (0, a + b + carry)
            assert len(total.value) == total.maximum.bit_length()
            m.d.comb += self.o[f"s{k}"].eq(pipeline.at(total, self.late + 1).value)
        return m


def adders(specs: list[Spec]) -> list[int]:
    """The widths of the adders in the circuit."""
    text = rtlil.convert(Fields(specs), emit_src=False)
    return [int(w) for w in re.findall(r"cell \$add .*?\\A_WIDTH (\d+)", text, re.DOTALL)]


SPECS: dict[str, list[Spec]] = {
    "one": [(255, 255, False)],
    "one and a carry": [(255, 255, True)],
    "a bit and a carry": [(1, 1, True)],
    "pixel": [(255, 255, False)] * 3,
    "all carry": [(15, 15, True)] * 4,
    "first without, then with": [(7, 7, False), (7, 7, True), (7, 7, False), (3, 1, True)],
    "unequal words": [(1, 200, True), (100, 3, False), (1, 1, True)],
    "zeros": [(0, 255, True), (255, 0, True), (9, 0, False)],
    "more than a chain": [(255, 255, k % 2 == 0) for k in range(9)],
    "wider than a chain": [(3, 3, True), (2**45 - 1, 2**45 - 1, True), (3, 3, True)],
    "not a power of two": [(9, 9, True), (5, 20, True), (765, 765, False)],
}


@pytest.mark.parametrize("late", [0, 1, 3])
@pytest.mark.parametrize("name", SPECS)
def test_every_field_is_its_own_sum(name: str, late: int) -> None:
    """With neighbours that are full or empty, where a carry that strays would show."""
    specs = SPECS[name]
    random = Random(len(name))

    def draw(maximum: int) -> int:
        return random.choice((0, maximum, maximum, random.randint(0, maximum)))

    sets: list[list[tuple[int, int, int]]] = [
        [(draw(a), draw(b), draw(int(carry))) for a, b, carry in specs] for _ in range(150)
    ]
    sets += [
        [(a, b, int(carry)) if (k == full) == on else (0, 0, 0) for k, (a, b, carry) in enumerate(specs)]
        for full, on in product(range(len(specs)), (False, True))
    ]
    clocks: list[Any] = [
        {"i": {f"{n}{k}": v for k, values in enumerate(s) for n, v in zip("abc", values, strict=True)}}
        for s in sets
    ]
    got = piped(Fields(specs, late), clocks)
    for values, o in zip(sets, got, strict=True):
        assert [o[f"s{k}"] for k in range(len(specs))] == [sum(v) for v in values], values


@pytest.mark.parametrize(
    ("name", "chains"),
    [("one", 1), ("pixel", 1), ("all carry", 1), ("more than a chain", 3), ("wider than a chain", 3)],
)
def test_fields_share_as_few_adders_as_chains_allow(name: str, chains: int) -> None:
    widths = adders(SPECS[name])
    assert len(widths) == chains
    assert sum(width > CHAIN_BITS for width in widths) == (name == "wider than a chain")


RANGES: list[tuple[Range, Range]] = [
    ((0, 15), (0, 15)),
    ((-16, 15), (-16, 15)),
    ((-9, 0), (0, 30)),
    ((-20, -3), (-1, 5)),
    ((-1, 0), (-32, 31)),
    ((0, 0), (-5, 5)),
]


@pytest.mark.parametrize(("a", "b"), RANGES)
def test_add_with_carry(a: Range, b: Range) -> None:
    low, high = a[0] + b[0], a[1] + b[1] + 1

    def build(p: Pipeline, w: Any) -> Word:
        return add_with_carry(w[0], w[1], w[2], low, high)

    dut = Arithmetic([a, b, (0, 1)], 1, build)
    sets = list(product(range(a[0], a[1] + 1), range(b[0], b[1] + 1), (0, 1)))
    got = piped(dut, [{"i": {"a0": x, "a1": y, "a2": c}} for x, y, c in sets])
    assert got == [sum(s) for s in sets]
    assert (dut.word.minimum, dut.word.maximum, dut.word.time) == (low, high, 1)
    assert dut.word.value.shape() == Shape.cast(range(low, high + 1))


@pytest.mark.parametrize("known", [(0, 7), (-4, 3), (-1, 0), (0, 1)])
def test_add_with_carry_within_a_narrower_range(known: Range) -> None:
    """The sum is known to be small: bits above its range are not computed, and no sign is lost."""
    dut = Arithmetic([(-16, 15), (-16, 15), (0, 1)], 1, lambda p, w: add_with_carry(*w, *known))
    sets = [s for s in product(range(-16, 16), range(-16, 16), (0, 1)) if known[0] <= sum(s) <= known[1]]
    got = piped(dut, [{"i": {"a0": x, "a1": y, "a2": c}} for x, y, c in sets])
    assert got == [sum(s) for s in sets]
    assert set(got) == set(range(known[0], known[1] + 1))


def test_operands_of_an_addition_with_carry_are_aligned() -> None:
    def build(p: Pipeline, w: Any) -> Word:
        late = p.subtract(p.subtract(w[0], w[1]), w[1])
        return add_with_carry(late, w[1], w[2], -20, 20)

    random = Random(5)
    sets = [(random.randrange(8), random.randrange(8), random.getrandbits(1)) for _ in range(100)]
    got = piped(
        Arithmetic([(0, 7), (0, 7), (0, 1)], 3, build),
        [{"i": {"a0": a, "a1": b, "a2": c}} for a, b, c in sets],
    )
    assert got == [a - b + c for a, b, c in sets]


def test_magnitude() -> None:
    def build(p: Pipeline, w: Any) -> Word:
        return magnitude(w[0], w[0].negative, 4, 15)

    got = piped(Arithmetic([(-15, 15)], 1, build), [{"i": {"a0": v}} for v in range(-15, 16)])
    assert got == [abs(v) for v in range(-15, 16)]


def test_distance_from_a_difference_less_1() -> None:
    def build(p: Pipeline, w: Any) -> Word:
        less_1 = w[0] + w[1].inverted
        return distance(less_1, less_1.negative, 4, 15)

    sets = list(product(range(16), repeat=2))
    got = piped(Arithmetic([(0, 15), (0, 15)], 2, build), [{"i": {"a0": a, "a1": b}} for a, b in sets])
    assert got == [abs(a - b) for a, b in sets]
