"""RuleArray: the factorised rules against all 27 of the table, each evaluated by itself."""

import itertools
from random import Random
from typing import Any

import pytest
from amaranth.back import rtlil

from softdepth.hdl.costs.fuzzy.rule_array import RuleArray
from tests.support.expected import conclusions, memberships
from tests.support.simulation import config, piped, sad


def inputs(one: int, bits: int) -> list[list[tuple[int, int, int]]]:
    """Memberships as they occur at and around every label, then anything at all, extremes included."""
    c = config(criteria=[sad(3, label_bits=bits)] * 3, membership_bits=bits)
    partition = [memberships(u, bits, c) for u in sorted({0, 1, one // 2, one - 1, one, one + 1, 2 * one})]
    random = Random(one)
    anything = [[tuple(random.choice((0, one, random.randint(0, one))) for _ in range(3)) for _ in range(3)]]
    anything += [[tuple(random.randint(0, one) for _ in range(3)) for _ in range(3)] for _ in range(150)]
    corners = [[(0, 0, 0)] * 3, [(one, one, one)] * 3]
    return [*map(list, itertools.product(partition, repeat=3)), *anything, *corners]  # type: ignore[list-item]


OPERATORS: list[dict[str, Any]] = [
    {"operator": "mean"},
    {"operator": "soft_min_1"},
    {"operator": "soft_min_1", "softness": 0.4},
    {"operator": "soft_min_2"},
    {"operator": "soft_min_2", "sharpness": -1.0},
    {"operator": "soft_min_2", "sharpness": 30.0},
]


@pytest.mark.parametrize(("table", "bits"), [("printed", 4), ("corrected", 4), ("printed", 8)])
@pytest.mark.parametrize("keys", OPERATORS, ids=str)
def test_every_conclusion_is_the_maximum_over_its_rules(keys: dict[str, Any], table: str, bits: int) -> None:
    """Also of memberships that no criterion gives: two of them full, or none."""
    c = config(disparities=2, lanes=1, rules=table, membership_bits=bits, **keys)
    sets = inputs(c.one, bits)
    dut = RuleArray(c)
    names = ("low", "middle", "high")
    got = piped(dut, [{"i": [dict(zip(names, degrees, strict=True)) for degrees in s]} for s in sets])
    reached = set()
    for degrees, o in zip(sets, got, strict=True):
        expected = conclusions(degrees, c)
        assert {k: o[f"y{k}"] for k in expected} == expected, degrees
        reached |= set(expected.values())
    assert (min(reached), max(reached)) == c.strength_range


def test_the_printed_table_takes_22_thetas_and_8_maxima() -> None:
    """In the circuit: an addition is one of MEAN's Thetas, a comparison belongs to a maximum."""
    text = rtlil.convert(RuleArray(config(operator="mean")), emit_src=False)
    assert text.count("cell $add ") == 22
    assert text.count("cell $gt ") == 8
