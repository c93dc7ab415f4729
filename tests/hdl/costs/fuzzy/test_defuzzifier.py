"""Defuzzifier: both sums with no bit lost, and the infinite cost where the denominator vanishes."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.costs.fuzzy.defuzzifier import Defuzzifier
from softdepth.spec.rules import CONCLUSIONS, weight
from tests.support.simulation import config, piped

KS = range(1, CONCLUSIONS + 1)

OPERATORS: list[dict[str, Any]] = [
    {"operator": "soft_min_2", "membership_bits": 2},
    # With the rules as printed, MEAN's conclusions do not reach their extremes together.
    {"operator": "mean", "membership_bits": 8, "rules": "corrected"},
    {"operator": "mean", "membership_bits": 12, "rules": "corrected"},
    {"operator": "soft_min_2", "membership_bits": 8},
    {"operator": "soft_min_1", "membership_bits": 8},  # may go below zero, and so may their sum
    {"operator": "soft_min_1", "membership_bits": 8, "softness": 0.5},
    {"operator": "soft_min_1", "membership_bits": 4, "softness": 0.5},
    {"operator": "soft_min_1", "membership_bits": 8, "softness": 1.0},  # never below zero again
]


@pytest.mark.parametrize("keys", OPERATORS, ids=str)
def test_numerator_and_denominator(keys: dict[str, Any]) -> None:
    c = config(disparities=2, **{"lanes": 1, **keys})
    low, high = c.strength_range
    random = Random(high)
    sets = [{k: high if k == j else low for k in KS} for j in KS]
    sets += [{k: low if k == j else high for k in KS} for j in KS]
    sets += [dict.fromkeys(KS, low), dict.fromkeys(KS, high)]
    sets += [{k: random.randint(low, high) for k in KS} for _ in range(60)]
    sets += [{k: 1 if k == j else 0 for k in KS} for j in KS]  # the smallest sum above zero
    if low < 0:
        sets += [{k: random.randint(low, -low) for k in KS} for _ in range(60)]  # sums about zero
        sets += [dict.fromkeys(KS, 0) | {1: 1, 11: -1}, dict.fromkeys(KS, 0) | {1: -1, 11: 1, 10: 1}]
        sets += [dict.fromkeys(KS, 0)]
    clocks = [{"i": {f"y{k}": v for k, v in s.items()}} for s in sets]
    num, den = (piped(Defuzzifier(c), clocks, output) for output in ("num", "den"))
    expected = []
    for s in sets:
        total = sum(s.values())
        vanishes = low < 0 and total <= 0
        expected.append((1, 0) if vanishes else (sum(v * weight(k) for k, v in s.items()), total))
    assert list(zip(num, den, strict=True)) == expected
    assert expected.count((1, 0)) > 20 or low == 0
    # The stated range is true, and reached but for infinite costs.
    (num_low, num_high), (den_low, den_high) = c.cost_range
    assert all(num_low <= n <= num_high and d <= den_high for n, d in expected)
    assert max(d for _, d in expected) == den_high
    assert low < 0 or min(d for _, d in expected) == den_low
