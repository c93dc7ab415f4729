"""The rule array and every inference, proven at the smallest membership width: all inputs, in every run."""

from itertools import product
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Assert, Cat, Module, Mux, Signal
from amaranth.lib.wiring import Component, In

from softdepth.hdl.costs.cost import inference_of
from softdepth.hdl.costs.fuzzy.cell_inference import CellInference
from softdepth.hdl.costs.fuzzy.rule_array import RuleArray
from softdepth.spec.config import Config
from softdepth.spec.rules import rule_base
from tests.support.expected import fraction
from tests.support.mutations import mutated
from tests.support.proofs import largest, late, looked_up, pipeline_proof
from tests.support.simulation import config, sad

BITS = 2
LABEL_BITS = 4


def small(**keys: Any) -> Config:
    """A configuration whose memberships are in quarters."""
    criteria = [sad(3, label_bits=LABEL_BITS)] * 3
    return config(disparities=2, lanes=1, criteria=criteria, membership_bits=BITS, **keys)


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
}
MAXIMA = [(4 << LABEL_BITS) - 1] * 3


@pytest.mark.parametrize("name", INFERENCES)
def test_an_inference_is_its_table(name: str, tmp_path: Path) -> None:
    c = small(**INFERENCES[name])
    dut = inference_of(c)(c, MAXIMA)
    assert pipeline_proof(Inferred(c, dut), tmp_path, dut.latency) == "every run"


def test_an_inference_with_a_fault_is_refuted(tmp_path: Path) -> None:
    c = small(**INFERENCES["min"])
    broken = mutated(
        CellInference,
        "add_with_carry(f_rise, g_fall.inverted, 1,",
        "add_with_carry(f_rise, g_fall.inverted, 0,",
    )
    dut = broken(c, MAXIMA)
    assert pipeline_proof(Inferred(c, dut), tmp_path, dut.latency) == "refuted"


class Fired(Component):
    """`RuleArray` of MEAN beside the 27 rules, each by itself, of any memberships at all."""

    degrees: In(9 * (BITS + 1))

    def __init__(self, c: Config, block: Any) -> None:
        self._config = c
        self._array = block(c)
        self.latency = self._array.latency
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.array = array = self._array
        one = self._config.one
        degrees: list[list[Signal]] = []
        for k in range(3):
            degrees.append([])
            for label, name in enumerate(("low", "middle", "high")):
                free = self.degrees.word_select(3 * k + label, BITS + 1)
                degree = Signal(range(one + 1), name=f"{name}_{k}")
                m.d.comb += [degree.eq(free), array.i[k][name].eq(degree)]
                with m.If(free > one):
                    m.d.comb += degree.eq(one)
                degrees[-1].append(degree)
        first, second, third = degrees
        right = []
        for k, rules in rule_base(self._config.rules).items():
            strengths = [first[a - 1] + (second[b - 1] + third[c - 1]) for a, b, c in rules]
            expected = late(m, largest(strengths), array.latency, f"expected_{k}")
            right.append(array.o[f"y{k}"] == expected)
        m.d.comb += Assert(Cat(right).all())
        return m


@pytest.mark.parametrize("rules", ["printed", "corrected"])
def test_the_rule_array_is_the_table(rules: str, tmp_path: Path) -> None:
    dut = Fired(small(operator="mean", rules=rules), RuleArray)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "every run"


FAULTS = {
    "a pair's own": ("membership(2, b), membership(3, c)", "membership(2, b), membership(3, b)"),
    "the other label": ("pipeline, membership(1, a),", "pipeline, membership(1, 4 - a),"),
    "the last rules alone": ("pipeline.tree(pipeline.max, fired)", "fired[-1]"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_rule_array_with_a_fault_is_refuted(fault: str, tmp_path: Path) -> None:
    dut = Fired(small(operator="mean"), mutated(RuleArray, *FAULTS[fault]))
    assert pipeline_proof(dut, tmp_path, dut.latency) == "refuted"
