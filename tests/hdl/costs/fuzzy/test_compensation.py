"""Compensation: both readings, off, every criterion it may look at, and the threshold's two sides."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.costs.fuzzy.compensation import Compensation
from tests.support.expected import compensated
from tests.support.simulation import config, piped, sad


@pytest.mark.parametrize("reading", ["off", "top", "literal"])
@pytest.mark.parametrize(
    "criteria",
    [
        [sad(3), sad(5), sad(7)],
        [sad(5, label_bits=8), sad(7, label_bits=15), sad(3, label_bits=9)],
        [sad(1, label_bits=12), sad(3, 2, label_bits=8), sad(3, label_bits=14)],  # 2T exceeds every sum
    ],
)
@pytest.mark.parametrize("criterion", range(4))
def test_replaces_all_criteria_of_a_near_candidate(
    reading: str, criteria: list[dict[str, int]], criterion: int
) -> None:
    threshold = 700
    rule = {"reading": reading, "threshold": threshold, "criterion": criterion}
    c = config(criteria=criteria, compensation=rule)
    centred = criteria.index(next(s for s in criteria if (s["window"], s["dx"]) == (3, 0)))
    looked_at = criterion - 1 if criterion else centred
    random = Random(5)
    sets = []
    for seen in (0, threshold - 1, threshold, threshold + 1, c.maxima[looked_at]):
        for near in (0, 1):
            for fill in ("random", "all zero", "all full"):
                values = [
                    {
                        "random": random.randint(0, s.maximum_of(c.pixel)),
                        "all zero": 0,
                        "all full": s.maximum_of(c.pixel),
                    }[fill]
                    for s in c.criteria
                ]
                values[looked_at] = seen
                sets.append((values, near))
    clocks: list[Any] = [{"i": {f"s{i}": v for i, v in enumerate(values)}, "near": n} for values, n in sets]
    got = piped(Compensation(c), clocks)
    changed = 0
    for (values, near), o in zip(sets, got, strict=True):
        expected = compensated(values, bool(near), c)
        assert [o[f"s{i}"] for i in range(3)] == expected, (values, near)
        changed += expected != values
    assert bool(changed) == (reading != "off")
