"""CellInference: every operator's rules of the criteria's cell, against the fixed model."""

from collections.abc import Sequence
from functools import partial
from itertools import product
from random import Random
from types import MappingProxyType
from typing import Any

import pytest

from softdepth.hdl.costs.cost import inference_of
from softdepth.hdl.costs.fuzzy import cell_rules
from softdepth.hdl.costs.fuzzy.cell_inference import CellInference
from softdepth.hdl.costs.fuzzy.cell_mean_inference import CellMeanInference
from softdepth.hdl.costs.fuzzy.cell_rules import cell_conclusions, joins_corners
from softdepth.hdl.costs.fuzzy.inference import RuleInference
from softdepth.hdl.costs.fuzzy.mean_inference import MeanInference
from softdepth.hdl.costs.fuzzy.operators import soft_extremum
from softdepth.spec import rules as rule_bases
from softdepth.spec.config import LITERAL_INPUT, Config, PixelFormat
from softdepth.spec.errors import ConfigError
from softdepth.spec.soft import soft_min_2_table
from tests.support.expected import fraction
from tests.support.inferences import Values, around_the_labels, gateware, model, positions, stimulus
from tests.support.inferences import settings as any_settings
from tests.support.simulation import config, observe

OPERATORS: list[dict[str, Any]] = [
    {"operator": "min"},
    {"operator": "prod"},
    {"operator": "mean"},
    {"operator": "soft_min_1"},
    {"operator": "soft_min_1", "softness": 0.3},
    {"operator": "soft_min_2", "sharpness": -100.0},
    {"operator": "soft_min_2", "sharpness": 100.0},
    {"operator": "soft_min_2", "sharpness": -8.0},
]
LONG_TABLES: list[dict[str, Any]] = [
    {"operator": "soft_min_1", "softness": 0.0},
    {"operator": "soft_min_1", "softness": 1.0},
    {"operator": "soft_min_2", "sharpness": 0.0},
    {"operator": "soft_min_2", "sharpness": -1.0},
    {"operator": "soft_min_2", "sharpness": 20.0},
    {"operator": "soft_min_2", "sharpness": -500.0},
]


settings = partial(any_settings, firing="cell")


def random_sets(c: Config, count: int) -> list[Values]:
    """Criteria by themselves, and such that two of their memberships are nearly equal."""
    random = Random(c.membership_bits)
    sets = []
    for k in range(count):
        values = [around_the_labels(c, i, random) for i in range(3)]
        if k % 2:
            i, j = random.sample(range(3), 2)
            top = 2 << c.criteria[i].label_bits
            mirrored = random.choice((values[i], abs(top // 2 - values[i]), abs(top - values[i])))
            step = 1 << (c.criteria[i].label_bits - c.membership_bits)
            near = mirrored + random.randint(-9, 9) * step
            values[j] = min(max(near, 0) * (2 << c.criteria[j].label_bits) // top, c.maxima[j])
        sets.append(tuple(values))
    return sets


def differing(c: Config, sets: Sequence[Values], maxima: list[int] | None = None) -> list[Any]:
    found = zip(sets, gateware(CellInference, c, sets, maxima), model(c, sets), strict=True)
    return [entry for entry in found if entry[1] != entry[2]]


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("keys", [*OPERATORS, *LONG_TABLES], ids=str)
def test_equals_the_fixed_model_at_every_position(keys: dict[str, Any], rules: str) -> None:
    c = settings(2, 4, 5, 7, rules=rules, **keys)
    sets = list(product(*(positions(c, i) for i in range(3))))
    assert not differing(c, sets)


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("operator", ["min", "prod", "soft_min_1", "soft_min_2"])
def test_equals_the_fixed_model_at_every_position_of_three_bits(operator: str, rules: str) -> None:
    c = settings(3, 4, 4, 4, rules=rules, operator=operator, softness=0.2, sharpness=-8.0)
    steps = [2 * u for u in range(2 * c.one + 1)]
    assert not differing(c, list(product(steps, repeat=3)))


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("keys", OPERATORS, ids=str)
def test_equals_the_fixed_model_at_eight_bits(keys: dict[str, Any], rules: str) -> None:
    c = settings(8, 12, 11, 13, windows=(9, 9, 9), rules=rules, **keys)
    assert not differing(c, random_sets(c, 1500))


@pytest.mark.parametrize("bits", [5, 12])
@pytest.mark.parametrize("keys", [*OPERATORS, *LONG_TABLES], ids=str)
def test_equals_the_fixed_model_at_other_widths(keys: dict[str, Any], bits: int) -> None:
    c = settings(bits, bits, 12, 14, windows=(9, 9, 9), **keys)
    assert not differing(c, random_sets(c, 400))


@pytest.mark.parametrize("windows", [(3, 1, 1), (1, 3, 1), (1, 1, 3)])
@pytest.mark.parametrize("operator", ["min", "prod", "mean", "soft_min_1", "soft_min_2"])
def test_criteria_that_never_reach_a_label(operator: str, windows: tuple[int, int, int]) -> None:
    """A window of one pixel and its colours stays below 2**10."""
    c = settings(4, 9, 10, 12, windows=windows, operator=operator)
    random = Random(5)
    sets = [tuple(random.randint(0, s.maximum_of(PixelFormat.RGB8)) for s in c.criteria) for _ in range(300)]
    assert not differing(c, [*sets, tuple(s.maximum_of(PixelFormat.RGB8) for s in c.criteria)])


def test_inputs_beyond_the_criteria() -> None:
    """The literal compensating rule gives 1000 to a criterion that by itself is smaller."""
    c = settings(4, 9, 9, 9, windows=(1, 3, 1), operator="min")
    maxima = [max(s.maximum_of(PixelFormat.RGB8), LITERAL_INPUT) for s in c.criteria]
    sets = list(product((0, 300, 511, 512, LITERAL_INPUT), repeat=3))
    assert not differing(c, sets, maxima)


@pytest.mark.parametrize("operator", ["min", "prod"])
@pytest.mark.parametrize("rules", ["printed", "corrected"])
def test_min_and_prod_are_exact_whatever_fires(operator: str, rules: str) -> None:
    """All 27 rules, each by itself, in plain Python."""
    c = settings(3, 4, 4, 4, operator=operator, rules=rules, firing="all")
    sets = list(product(range(0, 33, 2), repeat=3))
    assert gateware(CellInference, c, sets) == [fraction(values, False, c) for values in sets]


@pytest.mark.parametrize(
    ("keys", "kind"),
    [
        ({"operator": "min"}, CellInference),
        ({"operator": "prod", "firing": "cell"}, CellInference),
        ({"operator": "soft_min_1", "firing": "cell"}, CellInference),
        ({"operator": "soft_min_2", "firing": "cell", "rules": "corrected"}, CellInference),
        ({"operator": "mean", "firing": "cell"}, CellInference),
        ({"operator": "mean", "firing": "cell", "rules": "corrected"}, CellMeanInference),
        ({"operator": "mean"}, MeanInference),
        ({"operator": "mean", "rules": "corrected"}, RuleInference),
        ({"operator": "soft_min_1"}, RuleInference),
        ({"operator": "soft_min_2"}, RuleInference),
    ],
    ids=str,
)
def test_which_inference_a_configuration_gets(keys: dict[str, Any], kind: type) -> None:
    assert inference_of(config(disparities=2, lanes=1, **keys)) is kind


@pytest.mark.parametrize("operator", ["min", "prod", "mean", "soft_min_1", "soft_min_2"])
def test_a_fraction_comes_when_the_latency_says(operator: str) -> None:
    """A single candidate among others: its fraction is there so many clocks later, and at no other."""
    c = settings(8, 12, 12, 12, windows=(9, 9, 9), operator=operator)
    sets = [(0, 0, 0)] * 12 + [(9000, 2000, 5000)] + [(0, 0, 0)] * 12
    inputs = stimulus(sets)
    for output, expected in zip(("num", "den"), zip(*model(c, sets), strict=True), strict=True):
        dut = CellInference(c, [criterion.maximum_of(PixelFormat.RGB8) for criterion in c.criteria])
        got = observe(dut, inputs, output)[dut.latency :]
        assert [n for n, bits in enumerate(got) if bits != got[0]] == [12]
        assert (got[12] - expected[12]) % (1 << len(getattr(dut, output))) == 0


def test_the_cells_of_both_tables() -> None:
    assert joins_corners("printed")
    assert not joins_corners("corrected")
    for a, b, c, joins in product((False, True), repeat=4):
        found = cell_conclusions((a, b, c), joins=joins)
        assert sum(map(len, found.values())) == 8
        assert len(found) == 6 - (joins and ((b and c) or (a and not b and not c)))


def test_a_table_of_another_structure_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Any two rules of the corrected table exchanged, but the two that make it the printed one."""
    members = dict(rule_bases.CORRECTED)
    members[8], members[9] = (*members[8][:2], members[9][0]), (members[8][2], *members[9][1:])
    monkeypatch.setattr(cell_rules, "rule_base", lambda name: MappingProxyType(members))
    with pytest.raises(ConfigError, match="rules 'corrected' of a cell"):
        joins_corners("corrected")


@pytest.mark.parametrize("joins", [False, True])
def test_another_tables_corners_are_noticed(joins: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The comparison with the model tells the two tables apart."""
    c = settings(3, 4, 4, 4, operator="soft_min_1", rules="corrected" if joins else "printed")
    monkeypatch.setattr("softdepth.hdl.costs.fuzzy.cell_inference.joins_corners", lambda name: joins)
    found = differing(c, list(product(range(0, 33, 2), repeat=3)))
    above = [tuple(v >= 16 for v in values) for values, _, _ in found]
    assert set(above) == {(True, False, False), (False, True, True), (True, True, True)}


def test_a_table_off_by_one_place_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    table = soft_min_2_table(256, -100.0)
    monkeypatch.setattr(soft_extremum, "soft_min_2_table", lambda one, sharpness: (table[0], *table[:-1]))
    c = settings(8, 12, 12, 12, windows=(9, 9, 9), operator="soft_min_2")
    assert differing(c, random_sets(c, 400))
