"""CellMeanInference: the closed form equals the corrected rules of the criteria's cell, one by one."""

from collections.abc import Sequence
from functools import partial
from itertools import product
from random import Random
from typing import Any

import pytest

from softdepth.hdl.costs.fuzzy.cell_mean_inference import CellMeanInference
from softdepth.spec.config import LITERAL_INPUT, Config, PixelFormat
from softdepth.spec.rules import CORRECTED, PRINTED, RuleBase, weight
from tests.support.inferences import Values, around_the_labels, gateware, model, positions, small, stimulus
from tests.support.inferences import settings as any_settings
from tests.support.simulation import observe

settings = partial(any_settings, operator="mean", rules="corrected", firing="cell")
SMALL = small(settings)


def fraction(c: Config, values: Values, rules: RuleBase = CORRECTED) -> tuple[int, int]:
    """Numerator and denominator by the definition: the strongest rule of each conclusion in the cell."""
    one = c.one
    degrees: list[dict[int, int]] = []
    for value, criterion in zip(values, c.criteria, strict=True):
        u = min(value, 2 << criterion.label_bits) >> (criterion.label_bits - c.membership_bits)
        degrees.append({2: 2 * one - u, 3: u - one} if u >= one else {1: one - u, 2: u})
    num = den = 0
    for k, members in rules.items():
        fired = [
            sum(degree[label] for degree, label in zip(degrees, rule, strict=True))
            for rule in members
            if all(label in degree for degree, label in zip(degrees, rule, strict=True))
        ]
        strongest = max(fired, default=0)
        num += strongest * weight(k)
        den += strongest
    return num, den


def differing(c: Config, sets: Sequence[Values], maxima: list[int] | None = None) -> list[Any]:
    got = gateware(CellMeanInference, c, sets, maxima)
    wanted = [fraction(c, values) for values in sets]
    return [entry for entry in zip(sets, got, wanted, strict=True) if entry[1] != entry[2]]


@pytest.mark.parametrize("name", SMALL)
def test_equals_the_rules_at_every_position(name: str) -> None:
    c = SMALL[name]
    maxima = [criterion.maximum_of(PixelFormat.RGB8) for criterion in c.criteria]
    sets = list(product(*(positions(c, i, maximum) for i, maximum in enumerate(maxima))))
    assert differing(c, sets) == []


@pytest.mark.parametrize(
    ("c", "maxima"),
    [
        # What the compensating rule hands over: 2T in place of a criterion that falls short of it ...
        (settings(2, 12, 12, 13, windows=(1, 1, 3)), [2 << 12, 2 << 12, 2 << 13]),
        # ... or the literal input, for some labels far beyond 2T.
        (settings(2, 4, 12, 4, windows=(1, 3, 1)), [LITERAL_INPUT, 6885, LITERAL_INPUT]),
    ],
    ids=["2T", "literal"],
)
def test_what_exceeds_a_criterions_own_range(c: Config, maxima: list[int]) -> None:
    sets = list(product(*(positions(c, i, maximum) for i, maximum in enumerate(maxima))))
    assert any(
        v > s.maximum_of(PixelFormat.RGB8) for values in sets for v, s in zip(values, c.criteria, strict=True)
    )
    assert differing(c, sets, maxima) == []


@pytest.mark.parametrize(
    ("bits", "labels"), [(8, (12, 12, 12)), (8, (8, 10, 13)), (5, (9, 9, 9)), (12, (12, 13, 12))]
)
def test_equals_the_rules_at_many_bits(bits: int, labels: Values) -> None:
    c = settings(bits, *labels, windows=(9, 9, 9))
    random = Random(bits)
    sets = [tuple(around_the_labels(c, i, random) for i in range(3)) for _ in range(2500)]
    for _ in range(500):  # criteria 2 and 3 almost alike, where their difference changes its sign
        first, second = (around_the_labels(c, i, random) for i in (0, 1))
        shift = labels[2] - labels[1]
        third = (second << max(shift, 0) >> max(-shift, 0)) + random.randint(-1, 1)
        sets.append((first, second, min(max(third, 0), c.maxima[2])))
    for corner in product((0, 1, 2), repeat=3):  # the corners of all cells
        sets.append(tuple(at << label for at, label in zip(corner, labels, strict=True)))
    assert differing(c, sets) == []


@pytest.mark.parametrize("bits", [5, 8])
def test_equals_the_fixed_model(bits: int) -> None:
    c = settings(bits, 9, 9, 10, windows=(3, 5, 5))
    random = Random(bits)
    sets = [tuple(around_the_labels(c, i, random) for i in range(3)) for _ in range(1000)]
    assert gateware(CellMeanInference, c, sets) == model(c, sets)


def test_the_answer_comes_after_the_stated_latency() -> None:
    """A change of the criteria shows then, and not before."""
    c = settings(3, 4, 4, 4)
    before, after = (0, 0, 0), (64, 0, 40)
    for output, old, new in zip(("num", "den"), fraction(c, before), fraction(c, after), strict=True):
        dut = CellMeanInference(c, [64, 64, 64])
        clocks = [before] * (dut.latency + 2) + [after] * (dut.latency + 1)
        seen = observe(dut, stimulus(clocks), output)
        assert old != new
        assert seen[-dut.latency - 2 :] == [old] * (dut.latency + 1) + [new]


def test_the_closed_form_is_the_corrected_rules() -> None:
    """The docstring's formulas in integers are the definition; with the printed rules they are not."""
    c = settings(3, 4, 4, 4)
    sets = list(product(range(0, 34, 2), repeat=3))
    stated = [closed_form(c, values) for values in sets]
    assert stated == [fraction(c, values) for values in sets]
    assert stated != [fraction(c, values, PRINTED) for values in sets]


def closed_form(c: Config, values: Values) -> tuple[int, int]:
    """Both forms of the numerator in the component's docstring, which must agree; and the denominator."""
    one = c.one
    u = [
        min(v, 2 << s.label_bits) >> (s.label_bits - c.membership_bits)
        for v, s in zip(values, c.criteria, strict=True)
    ]
    a, b, c_ = (v >= one for v in u)
    first, second, third = (v - one * bit for v, bit in zip(u, (a, b, c_), strict=True))
    p = 3 * a + b + c_
    distance = abs(second - third)
    x, y = max(second, third), min(second, third)
    if not a:
        x, y = y, x
    z = x - y if a == b == c_ else (3 if b == c_ else 1) * (y - x)
    num = 9 * first + 4 * (second + third) + (2 * p - 5) * distance + (9 * p - 31) * one
    assert num == 8 * (first + p * one + x) + (first + (p + 1) * one + z) - 32 * one
    return num, 9 * one + 2 * distance


@pytest.mark.parametrize("bits", [2, 3])
def test_the_stated_range_is_reached_and_never_left(bits: int) -> None:
    """By the definition, over all positions: so no bit of the numerator is missing, and none is idle."""
    c = settings(bits, 4, 4, 4)
    unit = 1 << (4 - bits)
    values = [u * unit for u in range(2 * c.one + 1)]
    num, den = zip(*(fraction(c, each) for each in product(values, repeat=3)), strict=True)
    (num_low, num_high), den_range = c.cost_range
    assert num_low // 2 > min(num) >= num_low
    assert max(num) == num_high
    assert (min(den), max(den)) == den_range
