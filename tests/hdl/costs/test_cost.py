"""The costs: the whole inference of a candidate, and the plain SAD."""

from itertools import product
from random import Random
from typing import Any

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.hdl.costs.cost import COSTS
from softdepth.spec.config import Config
from tests.support.expected import fraction
from tests.support.simulation import config, piped, sad

Set = tuple[list[int], bool]
CASES = [
    ("off", "printed", [sad(3), sad(5), sad(7)]),
    ("top", "corrected", [sad(3, label_bits=10), sad(5, label_bits=11), sad(7, label_bits=13)]),
    ("literal", "printed", [sad(5, 1, label_bits=9), sad(3, label_bits=9), sad(1, label_bits=8)]),
]


def random_sets(c: Config, count: int) -> list[Set]:
    """Criteria of several scales, and at the labels themselves; near candidates, and others."""
    random = Random(11)
    sets = []
    for k in range(count):
        scale = random.choice((0.05, 0.3, 1.0))
        values = [random.randint(0, int(most * scale)) for most in c.maxima]
        if k % 10 == 0:
            values = [
                random.choice((0, min(1 << s.label_bits, most), most))
                for s, most in zip(c.criteria, c.maxima, strict=True)
            ]
        sets.append((values, bool(random.getrandbits(1))))
    return sets


def costs(c: Config, sets: list[Set]) -> list[tuple[int, int]]:
    """Numerator and denominator as the gateware has them."""
    clocks: list[Any] = [{"i": {f"s{i}": v for i, v in enumerate(s)}, "near": near} for s, near in sets]
    return [(o.num, o.den) for o in piped(COSTS["fuzzy"](c), clocks)]


def model(c: Config, sets: list[Set]) -> list[tuple[int, int]]:
    """The same from the fixed model; a candidate's disparity says whether it is near."""
    found = []
    for values, near in sets:
        d = c.compensation.from_disparity if near else 0
        n, s = fixed_model.fraction(c, d, [np.array([v], np.int32) for v in values])
        found.append((n.item(), s.item()))
    return found


@pytest.mark.parametrize(
    "keys",
    [
        {"operator": "min"},
        {"operator": "prod"},
        {"operator": "mean"},
        {"operator": "soft_min_1"},
        {"operator": "soft_min_1", "softness": 0.4, "membership_bits": 4},
        {"operator": "soft_min_2"},
        {"operator": "soft_min_2", "sharpness": 30.0},
        {"operator": "soft_min_2", "sharpness": -10.0},
        {"operator": "mean", "firing": "cell"},
        {"operator": "soft_min_1", "firing": "cell"},
        {"operator": "soft_min_2", "firing": "cell"},
    ],
    ids=str,
)
@pytest.mark.parametrize(("reading", "table", "criteria"), CASES)
def test_fuzzy_cost(keys: dict[str, Any], reading: str, table: str, criteria: list[dict[str, int]]) -> None:
    """Against plain Python and against the fixed model."""
    c = config(
        rules=table, criteria=criteria, disparities=64, lanes=1, compensation={"reading": reading}, **keys
    )
    sets = random_sets(c, 120)
    got = costs(c, sets)
    assert got == [fraction(values, near, c) for values, near in sets]
    assert got == model(c, sets)


def test_a_denominator_of_zero_or_below_gives_one_over_zero() -> None:
    """Soft-min I in few bits: all combinations of its inputs, of which 140 vanish."""
    criteria = [sad(3, label_bits=4)] * 3
    c = config(
        operator="soft_min_1", softness=0.4, membership_bits=3, criteria=criteria, disparities=2, lanes=1
    )
    sets: list[Set] = [([2 * u for u in us], False) for us in product(range(2 * c.one + 1), repeat=3)]
    got = costs(c, sets)
    assert got == [fraction(values, near, c) for values, near in sets]
    assert got == model(c, sets)
    assert got.count((1, 0)) == 140
    assert min(den for _, den in got if den) == 1


SMALL = [
    *({"operator": name} for name in ("min", "prod", "mean", "soft_min_1", "soft_min_2")),
    *({"operator": name, "firing": "cell"} for name in ("mean", "soft_min_1", "soft_min_2")),
    {"operator": "mean", "firing": "cell", "rules": "corrected"},
]


@pytest.mark.parametrize("bits", [2, 3])
@pytest.mark.parametrize("keys", SMALL, ids=str)
def test_criteria_that_never_reach_their_labels(keys: dict[str, Any], bits: int) -> None:
    """Whose maximum, 765, lies below T, or between T and 2T: all combinations of their inputs."""
    criteria = [sad(1, label_bits=10), sad(3, label_bits=bits + 9), sad(1, label_bits=9)]
    c = config(criteria=criteria, membership_bits=bits, disparities=2, lanes=1, **keys)
    assert [most >> s.label_bits for most, s in zip(c.maxima, c.criteria, strict=True)] == [
        0,
        3 >> bits - 2,
        1,
    ]
    steps = [
        sorted({*range(0, min(most, 2 << s.label_bits) + 1, 1 << s.label_bits - bits), most})
        for most, s in zip(c.maxima, c.criteria, strict=True)
    ]
    sets: list[Set] = [(list(values), False) for values in product(*steps)]
    got = costs(c, sets)
    assert got == [fraction(values, near, c) for values, near in sets]
    assert got == model(c, sets)


def test_sad_cost_is_the_criterion_itself() -> None:
    c = config(cost="sum", criteria=[sad(5)])
    values = [0, 1, 4096, c.maxima[0]]
    got = piped(COSTS["sum"](c), [{"i": {"s0": v}, "near": 1} for v in values])
    assert [(o.num, o.den) for o in got] == [(v, 0) for v in values]
