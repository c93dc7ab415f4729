"""The costs: the whole inference of a candidate, and the plain SAD."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.cost import COSTS

from .expected import fraction
from .support import config, piped, sad


@pytest.mark.parametrize("operator", ["min", "mean"])
@pytest.mark.parametrize(
    ("reading", "table", "criteria"),
    [
        ("off", "printed", [sad(3), sad(5), sad(7)]),
        ("top", "corrected", [sad(3, label_bits=10), sad(5, label_bits=11), sad(7, label_bits=13)]),
        ("literal", "printed", [sad(5, 1, label_bits=9), sad(3, label_bits=9), sad(1, label_bits=8)]),
    ],
)
def test_fuzzy_cost(operator: str, reading: str, table: str, criteria: list[dict[str, int]]) -> None:
    c = config(operator=operator, rules=table, criteria=criteria, compensation={"reading": reading})
    random = Random(11)
    sets = []
    for k in range(120):
        scale = random.choice((0.05, 0.3, 1.0))
        values = [random.randint(0, int(s.maximum * scale)) for s in c.criteria]
        if k % 10 == 0:
            values = [random.choice((0, min(1 << s.label_bits, s.maximum), s.maximum)) for s in c.criteria]
        sets.append((values, random.getrandbits(1)))
    clocks: list[Any] = [{"i": {f"s{i}": v for i, v in enumerate(values)}} for values, _ in sets]
    for ports, (_, near) in zip(clocks, sets, strict=True):
        ports["near"] = near
    got = [(o.num, o.den) for o in piped(COSTS["fuzzy"](c), clocks)]
    assert got == [fraction(values, bool(near), c) for values, near in sets]


def test_sad_cost_is_the_criterion_itself() -> None:
    c = config(cost="sad", criteria=[sad(5)])
    values = [0, 1, 4096, c.criteria[0].maximum]
    got = piped(COSTS["sad"](c), [{"i": {"s0": v}, "near": 1} for v in values])
    assert [(o.num, o.den) for o in got] == [(v, 0) for v in values]
