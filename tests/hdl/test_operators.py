"""The operators: both halves together give Theta, and both are monotone."""

import itertools
from typing import Any

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth import config as configuration
from softdepth.errors import ConfigError
from softdepth.hdl.operators import OPERATORS, operator
from softdepth.hdl.pipeline import Pipeline

from .expected import theta
from .support import config, piped

ONE = 4


class Theta(wiring.Component):
    """One operator over three memberships of 0 .. 4."""

    def __init__(self, name: str) -> None:
        self.unit = operator(config(operator=name))
        self.latency = self.unit.pair_latency + self.unit.fire_latency
        degree = In(range(ONE + 1))
        super().__init__({"a": degree, "b": degree, "c": degree, "o": Out(range(self.unit.maximum(ONE) + 1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        p = Pipeline(m)
        a, b, c = (p.input(x, ONE) for x in (self.a, self.b, self.c))
        pair = self.unit.pair(p, b, c)
        assert pair.time == self.unit.pair_latency
        strength = self.unit.fire(p, a, pair)
        assert strength.time == self.latency
        assert (strength.minimum, strength.maximum) == (0, self.unit.maximum(ONE))
        m.d.comb += self.o.eq(strength.value)
        return m


@pytest.mark.parametrize("name", ["min", "mean"])
def test_theta_of_all_memberships(name: str) -> None:
    triples = list(itertools.product(range(ONE + 1), repeat=3))
    got = piped(Theta(name), [dict(zip("abc", t, strict=True)) for t in triples])
    assert got == [theta(name, *t) for t in triples]
    assert max(got) == operator(config(operator=name)).maximum(ONE)


@pytest.mark.parametrize("name", OPERATORS)
def test_monotone_in_every_operand(name: str) -> None:
    triples = list(itertools.product(range(ONE + 1), repeat=3))
    got: dict[Any, int] = dict(
        zip(triples, piped(Theta(name), [dict(zip("abc", t, strict=True)) for t in triples]), strict=True)
    )
    for t in triples:
        for k in range(3):
            if t[k] < ONE:
                larger = tuple(v + (i == k) for i, v in enumerate(t))
                assert got[t] <= got[larger]


@pytest.mark.parametrize("name", [n for n in configuration.OPERATORS if n not in OPERATORS])
def test_an_operator_without_gateware_is_refused(name: str) -> None:
    with pytest.raises(ConfigError, match=f"'{name}' has no gateware.*min, mean"):
        operator(config(operator=name))
