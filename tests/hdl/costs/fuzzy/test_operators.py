"""The operators' units against the paper's equations: all inputs at few bits, and 8 bits at random."""

import itertools
from random import Random
from typing import Any

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start
from softdepth.hdl.costs.fuzzy.operators import CELL_OPERATORS, OPERATORS
from softdepth.spec import config as configuration
from softdepth.spec.config import Config
from tests.support.expected import theta
from tests.support.simulation import config, piped

SOFTNESSES = (0.0, 0.05, 0.4, 1.0)
SHARPNESSES = (-500.0, -100.0, -1.0, 0.0, 1.0, 30.0, 100.0, 500.0)
Triple = tuple[int, ...]


def settings(bits: int) -> list[Config]:
    """Every operator whose rules can all fire, the soft ones in all their shapes."""
    keys: list[dict[str, Any]] = [{"operator": "mean"}]
    keys += [{"operator": "soft_min_1", "softness": value} for value in SOFTNESSES]
    keys += [{"operator": "soft_min_2", "sharpness": value} for value in SHARPNESSES]
    return [config(disparities=2, lanes=1, membership_bits=bits, **k) for k in keys]


def named(c: Any) -> str:
    return f"{c.operator} {c.softness} {c.sharpness}" if isinstance(c, Config) else str(c)


class Theta(wiring.Component):
    """One operator over three memberships."""

    def __init__(self, c: Config) -> None:
        self.config = c
        self.unit = OPERATORS[c.operator](c)
        self.operations = self.unit.pair_operations + self.unit.fire_operations
        self.latency = clocks(self.operations)
        degree = In(range(c.one + 1))
        low, high = c.strength_range
        super().__init__({"a": degree, "b": degree, "c": degree, "o": Out(range(low, high + 1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        p = Pipeline(m)
        begin = start(self.operations)
        a, b, c = (p.input(getattr(self, name), self.config.one, name, time=begin) for name in "abc")
        pair = self.unit.pair(p, b, c)
        assert pair.time == begin + self.unit.pair_operations
        strength = self.unit.fire(p, a, pair)
        assert strength.time == begin + self.operations
        assert p.clock(strength) == self.latency
        assert (strength.minimum, strength.maximum) == self.config.strength_range
        m.d.comb += self.o.eq(strength.value)
        return m


def strengths(c: Config, triples: list[Triple]) -> list[int]:
    """What the gateware makes of these memberships."""
    return piped(Theta(c), [dict(zip("abc", t, strict=True)) for t in triples])


def every(c: Config) -> list[Triple]:
    return list(itertools.product(range(c.one + 1), repeat=3))


@pytest.mark.parametrize("c", [*settings(2), *settings(3)], ids=named)
def test_theta_of_all_memberships(c: Config) -> None:
    triples = every(c)
    got = strengths(c, triples)
    assert got == [theta(x, y, z, c) for x, y, z in triples]
    assert (min(got), max(got)) == c.strength_range  # which are true bounds, and reached


@pytest.mark.parametrize("c", settings(8), ids=named)
def test_theta_at_eight_bits(c: Config) -> None:
    """At random, at close and at equal operands, where the tables act, and at all extremes."""
    random = Random(8)
    triples: list[Triple] = list(itertools.product((0, 1, 127, 128, 255, 256), repeat=3))
    for _ in range(250):
        a, b = (random.randint(0, 256) for _ in range(2))
        near = [min(max(a + random.randint(-12, 12), 0), 256) for _ in range(2)]
        triples += [(a, b, random.randint(0, 256)), (a, *near), (a, b, near[0])]
    assert strengths(c, triples) == [theta(x, y, z, c) for x, y, z in triples]


@pytest.mark.parametrize("c", [c for c in settings(3) if c.operator != "soft_min_2"], ids=named)
def test_monotone_in_every_operand(c: Config) -> None:
    """What lets the rule array take the maximum before Theta."""
    triples = every(c)
    got = dict(zip(triples, strengths(c, triples), strict=True))
    for t in triples:
        for k in range(3):
            if t[k] < c.one:
                larger = tuple(v + (i == k) for i, v in enumerate(t))
                assert got[t] <= got[larger]


@pytest.mark.parametrize("sharpness", [-30.0, 30.0])
def test_soft_min_2_is_not_monotone(sharpness: float) -> None:
    """A larger operand may weaken the rule: so the order in which rules are joined is part of it."""
    c = config(disparities=2, lanes=1, operator="soft_min_2", sharpness=sharpness, membership_bits=8)
    triples: list[Triple] = [(a, 128, 128) for a in range(257)]
    got = strengths(c, triples)
    assert any(after < before for before, after in itertools.pairwise(got))


def test_every_operator_has_its_unit() -> None:
    """Rules outside the cell have no strength with MIN and PROD, which need no other unit than the cell's."""
    assert tuple(CELL_OPERATORS) == configuration.OPERATORS
    other = {name for name in CELL_OPERATORS if not config(operator=name, disparities=2, lanes=1).by_cell}
    assert set(OPERATORS) == other
