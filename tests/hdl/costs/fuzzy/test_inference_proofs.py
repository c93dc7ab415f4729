"""The rule array and every inference, proven at the smallest membership width: all inputs, in every run."""

from itertools import product
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Assert, Cat, Module, Mux, Signal, Value
from amaranth.lib.wiring import Component, In

from softdepth.hdl.costs.cost import inference_of
from softdepth.hdl.costs.fuzzy.cell_inference import CellInference
from softdepth.hdl.costs.fuzzy.rule_array import RuleArray
from softdepth.spec.config import Config
from softdepth.spec.rules import rule_base
from tests.support.claims import Claim
from tests.support.expected import fraction, theta_2
from tests.support.mutations import mutated
from tests.support.proofs import largest, late, looked_up, pipeline_proof
from tests.support.simulation import config, sad

pytestmark = pytest.mark.formal

BITS = 2
LABEL_BITS = 4


INFERENCE = Claim(
    "the whole inference of MIN and PROD by cell, of MEAN, soft-min I and soft-min II with all rules and"
    " by cell:"
    " numerator and denominator are those of the table",
    sizes="memberships in quarters, all criteria from 0 to beyond 2T",
    depth="every run",
)
RULES = Claim(
    "the rule array of MEAN, soft-min I and II, and II as a maximum gives each conclusion as the maximum"
    " over its"
    " rules, of any memberships; the rules as printed, and MEAN's corrected ones (the others' with `make"
    " formal`)",
    sizes="memberships in quarters, of soft-min I in eighths too, as its softness does not show in quarters",
    depth="every run",
)


def small(**keys: Any) -> Config:
    """A configuration whose memberships are in quarters."""
    criteria = [sad(3, label_bits=LABEL_BITS)] * 3
    return config(disparities=2, lanes=1, criteria=criteria, **{"membership_bits": BITS, **keys})


class Inferred(Component):
    """An inference beside the table of all costs: three criteria from 0 to beyond 2T."""

    values: In(3 * (LABEL_BITS + 2))

    def __init__(self, c: Config, dut: Any) -> None:
        self._config, self._dut = c, dut
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.dut = dut = self._dut
        size = LABEL_BITS + 2
        top = 2 << BITS  # 2T, in steps of a criterion that memberships tell apart
        costs = {
            key: fraction([k << LABEL_BITS - BITS for k in key], False, self._config)
            for key in product(range(top + 1), repeat=3)
        }
        low = min(num for num, _ in costs.values())
        values = [self.values[k * size : (k + 1) * size] for k in range(3)]
        places = []
        for value in values:
            place = value[LABEL_BITS - BITS :]
            places.append(Mux(place > top, top, place)[: len(place)])
        num = looked_up({key: num - low for key, (num, _) in costs.items()}, *places)
        den = looked_up({key: den for key, (_, den) in costs.items()}, *places)
        for k, value in enumerate(values):
            m.d.comb += dut.i[f"s{k}"].eq(value)
        expected = late(m, Cat(num, den), dut.latency, "expected")
        got = Signal.like(expected, name="got")
        m.d.comb += got.eq(Cat((dut.num - low)[: len(num)], dut.den))
        m.d.comb += Assert(got == expected)
        return m


INFERENCES: dict[str, dict[str, Any]] = {
    "min": {"operator": "min", "firing": "cell"},
    "prod": {"operator": "prod", "firing": "cell"},
    "mean": {"operator": "mean"},
    "mean by cell": {"operator": "mean", "firing": "cell", "rules": "corrected"},
    "soft_min_1": {"operator": "soft_min_1"},
    "soft_min_1 by cell": {"operator": "soft_min_1", "firing": "cell", "softness": 0.4},
    "soft_min_2": {"operator": "soft_min_2", "sharpness": 2.0},
    "soft_min_2, a maximum, by cell": {"operator": "soft_min_2", "firing": "cell", "rules": "corrected"},
}
MAXIMA = [(4 << LABEL_BITS) - 1] * 3


LONG = {"soft_min_1 by cell", "soft_min_2"}


@INFERENCE.proven
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.full if name in LONG else []) for name in INFERENCES]
)
def test_an_inference_is_its_table(name: str, tmp_path: Path) -> None:
    c = small(**INFERENCES[name])
    dut = inference_of(c)(c, MAXIMA)
    assert pipeline_proof(Inferred(c, dut), tmp_path, dut.latency) == "every run"


@INFERENCE.refuted
def test_an_inference_with_a_fault_is_refuted(tmp_path: Path) -> None:
    c = small(**INFERENCES["min"])
    broken = mutated(
        CellInference,
        "add_with_carry(f_rise, g_fall.inverted, 1,",
        "add_with_carry(f_rise, g_fall.inverted, 0,",
    )
    dut = broken(c, MAXIMA)
    assert pipeline_proof(Inferred(c, dut), tmp_path, dut.latency) == "refuted"


def theta_table(config: Config, seconds: range) -> tuple[dict[tuple[int, ...], int], range]:
    """The fuzzy AND of a degree and a number of `seconds`, counted from their least; and of what range it is.

    Its entries are counted from the least of that range as well.
    """
    keys = product(range(config.one + 1), range(len(seconds)))
    found = {(a, b): theta_2(a, seconds[b], config) for a, b in keys}
    low, high = min(found.values()), max(found.values())
    return {key: value - low for key, value in found.items()}, range(low, high + 1)


class Fired(Component):
    """`RuleArray` beside the 27 rules, each by itself, of any memberships at all."""

    def __init__(self, c: Config, block: Any) -> None:
        self._config = c
        self._array = block(c)
        self.latency = self._array.latency
        super().__init__({"degrees": In(9 * (c.membership_bits + 1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.array = array = self._array
        one = self._config.one
        degrees: list[list[Signal]] = []
        for k in range(3):
            degrees.append([])
            for label, name in enumerate(("low", "middle", "high")):
                free = self.degrees.word_select(3 * k + label, self._config.membership_bits + 1)
                degree = Signal(range(one + 1), name=f"{name}_{k}")
                m.d.comb += [degree.eq(free), array.i[k][name].eq(degree)]
                with m.If(free > one):
                    m.d.comb += degree.eq(one)
                degrees[-1].append(degree)
        right = []
        for k, rules in rule_base(self._config.rules).items():
            strengths, low = self._strengths(m, degrees, rules)
            expected = late(m, largest(strengths), array.latency, f"expected_{k}")
            right.append(array.o[f"y{k}"] == expected + low)
        m.d.comb += Assert(Cat(right).all())
        return m

    def _strengths(self, m: Module, degrees: list[list[Signal]], rules: Any) -> tuple[list[Value], int]:
        """Of each rule, above the least of any; where the operator is not monotone, of those that agree in
        criterion 1."""
        first, second, third = degrees
        if self._config.operator == "mean":
            return [first[a - 1] + (second[b - 1] + third[c - 1]) for a, b, c in rules], 0
        pairs, between = theta_table(self._config, range(self._config.one + 1))
        whole, strengths = theta_table(self._config, between)
        joined = {(a, b, c): looked_up(pairs, second[b - 1], third[c - 1]) for a, b, c in rules}
        if self._config.operator == "soft_min_2":
            labels = {a for a, _, _ in rules}
            joined = {(a,): largest([v for rule, v in joined.items() if rule[0] == a]) for a in labels}
        found = []
        for rule, pair in joined.items():
            held = Signal(range(len(between)), name=f"pair_{'_'.join(map(str, rule))}")
            m.d.comb += held.eq(pair)
            found.append(looked_up(whole, first[rule[0] - 1], held))
        return found, strengths[0]


OPERATORS: dict[str, dict[str, Any]] = {
    "mean": {"operator": "mean"},
    "soft_min_1": {"operator": "soft_min_1"},
    # In quarters soft-min I is the minimum: softness shows in eighths, below 0 too.
    "soft_min_1, softer": {"operator": "soft_min_1", "softness": 0.4, "membership_bits": 3},
    "soft_min_2, a maximum": {"operator": "soft_min_2"},
    "soft_min_2": {"operator": "soft_min_2", "sharpness": 2.0},
}


QUICK = {"mean", "soft_min_1, softer", "soft_min_2"}


@RULES.proven
@pytest.mark.parametrize("rules", ["printed", pytest.param("corrected", marks=pytest.mark.full)])
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else pytest.mark.full) for name in OPERATORS]
)
def test_the_rule_array_is_the_table(name: str, rules: str, tmp_path: Path) -> None:
    dut = Fired(small(rules=rules, **OPERATORS[name]), RuleArray)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "every run"


FAULTS = {
    "a pair's own": ("membership(2, b), membership(3, c)", "membership(2, b), membership(3, b)"),
    "the other label": ("pipeline, membership(1, a),", "pipeline, membership(1, 4 - a),"),
    "the last rules alone": ("pipeline.tree(pipeline.max, fired)", "fired[-1]"),
}


@RULES.refuted
@pytest.mark.parametrize("fault", FAULTS)
def test_a_rule_array_with_a_fault_is_refuted(fault: str, tmp_path: Path) -> None:
    dut = Fired(small(operator="mean"), mutated(RuleArray, *FAULTS[fault]))
    assert pipeline_proof(dut, tmp_path, dut.latency) == "refuted"


@RULES.refuted
def test_a_rule_array_of_another_operator_is_refuted(tmp_path: Path) -> None:
    softer = small(**OPERATORS["soft_min_1, softer"])
    dut = Fired(small(operator="soft_min_1", membership_bits=3), lambda _: RuleArray(softer))
    assert pipeline_proof(dut, tmp_path, dut.latency) == "refuted"
