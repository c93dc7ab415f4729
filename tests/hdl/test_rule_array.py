"""RuleArray: the factorised rules against all 27 of the table, each evaluated by itself."""

import itertools
from random import Random
from typing import Any

import pytest

from softdepth.hdl.operators.minimum import Minimum
from softdepth.hdl.pipeline import Pipeline
from softdepth.hdl.rule_array import RuleArray

from .expected import conclusions, memberships
from .support import config, observe, piped, sad


def inputs(one: int, bits: int) -> list[list[tuple[int, int, int]]]:
    """Memberships as they occur at and around every label, then anything at all, extremes included."""
    c = config(criteria=[sad(3, label_bits=bits)] * 3, membership_bits=bits)
    partition = [memberships(u, bits, c) for u in sorted({0, 1, one // 2, one - 1, one, one + 1, 2 * one})]
    random = Random(one)
    anything = [[tuple(random.choice((0, one, random.randint(0, one))) for _ in range(3)) for _ in range(3)]]
    anything += [[tuple(random.randint(0, one) for _ in range(3)) for _ in range(3)] for _ in range(150)]
    corners = [[(0, 0, 0)] * 3, [(one, one, one)] * 3]
    return [*map(list, itertools.product(partition, repeat=3)), *anything, *corners]  # type: ignore[list-item]


@pytest.mark.parametrize(("table", "bits"), [("printed", 4), ("corrected", 4), ("printed", 8)])
@pytest.mark.parametrize("operator", ["min", "mean"])
def test_every_conclusion_is_the_maximum_over_its_rules(operator: str, table: str, bits: int) -> None:
    c = config(operator=operator, rules=table, membership_bits=bits)
    sets = inputs(c.one, bits)
    dut = RuleArray(c)
    names = ("low", "middle", "high")
    got = piped(dut, [{"i": [dict(zip(names, degrees, strict=True)) for degrees in s]} for s in sets])
    reached = 0
    for degrees, o in zip(sets, got, strict=True):
        expected = conclusions(degrees, c)
        assert {k: o[f"y{k}"] for k in expected} == expected, degrees
        reached = max(reached, *expected.values())
    assert dut.maximum == reached


def test_the_printed_table_takes_22_thetas_and_8_maxima(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []

    def counted(owner: type, name: str) -> None:
        original = getattr(owner, name)

        def call(*arguments: Any) -> Any:
            calls.append(name)
            return original(*arguments)

        monkeypatch.setattr(owner, name, call)

    for owner, name in ((Minimum, "pair"), (Minimum, "fire"), (Pipeline, "max")):
        counted(owner, name)
    observe(RuleArray(config(operator="min")), [{}], "o")
    assert calls.count("pair") + calls.count("fire") == 22
    assert calls.count("max") == 8
