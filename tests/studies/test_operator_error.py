"""The exhaustive error of the fixed-point operators: bounds at 8 bits, and the search itself."""

import itertools
import math
import re

import pytest

from softdepth.spec.config import OPERATORS, Config
from softdepth.spec.errors import ConfigError
from softdepth.studies import operator_error as module
from softdepth.studies.operator_error import operator_error


def config(operator: str, bits: int, **changes: object) -> Config:
    settings = {"operator": operator, "membership_bits": bits, "lanes": 1, **changes}
    return Config.preset("paper").override([f"{key}={value}" for key, value in settings.items()])


@pytest.mark.parametrize("operator", ["min", "mean"])
def test_min_and_mean_are_exact(operator):
    found = operator_error(config(operator, 8))
    assert (found.worst, found.rms, found.steps) == (0, 0, 0)


@pytest.mark.parametrize("operator", ["prod", "soft_min_1"])
def test_nested_operators_stay_within_one_step(operator):
    found = operator_error(config(operator, 8))
    assert 0.5 < found.steps < 1, "two roundings of up to half a step"
    assert 0 < found.mean < found.rms < found.worst < 1 / 256


@pytest.mark.parametrize("k", [-100.0, 100.0])
def test_soft_min_2_against_both_forms(k):
    nested = operator_error(config("soft_min_2", 8, sharpness=k), "nested")
    at_once = operator_error(config("soft_min_2", 8, sharpness=k))
    assert 0.5 < nested.steps <= 1
    assert nested.steps < at_once.steps < 1.25, "three weights are another function than two twice"


def scalar(operator: str, a: float, b: float, c: float, *, nested: bool) -> float:
    """The paper's formulas in plain Python."""

    def soft(x: float, y: float) -> float:
        return (x + y + 0.05**2 - math.sqrt((x - y) ** 2 + 0.05**2)) / 2

    def weighted(*values: float) -> float:
        weights = [math.exp(100 * v) for v in values]
        return sum(v * w for v, w in zip(values, weights, strict=True)) / sum(weights)

    match operator:
        case "min":
            return min(a, b, c)
        case "prod":
            return a * b * c
        case "mean":
            return (a + b + c) / 3
        case "soft_min_1":
            return soft(a, soft(b, c))
        case _:
            return weighted(a, weighted(b, c)) if nested else weighted(a, b, c)


@pytest.mark.parametrize("nested", [False, True])
@pytest.mark.parametrize("operator", OPERATORS)
def test_the_search_agrees_with_loops(operator, nested):
    chosen = config(operator, 3)
    theta = module.pair_operator(chosen)
    one, scale = chosen.one, chosen.one * (3 if operator == "mean" else 1)
    levels = module.levels_of(chosen)
    errors = {}
    for a, b, c in itertools.product(range(one + 1), repeat=3):
        strength = theta(levels[a : a + 1], theta(levels[b : b + 1], levels[c : c + 1])).item() / scale
        errors[a, b, c] = abs(strength - scalar(operator, a / one, b / one, c / one, nested=nested))
    found = operator_error(chosen, "nested" if nested else "at once")
    assert found.worst == pytest.approx(max(errors.values()), abs=1e-11)
    assert errors[found.inputs] == pytest.approx(found.worst, abs=1e-11)
    assert found.mean == pytest.approx(sum(errors.values()) / len(errors), abs=1e-11)
    assert found.rms == pytest.approx(math.sqrt(sum(e**2 for e in errors.values()) / len(errors)), abs=1e-11)
    assert found.steps == pytest.approx(found.worst * one)


def test_one_wrong_combination_is_found(monkeypatch):
    right = module.pair_operator

    def wrong(chosen):
        theta = right(chosen)
        return lambda a, b: theta(a, b) + ((a == 11) & (b == 3))

    monkeypatch.setattr(module, "pair_operator", wrong)
    found = operator_error(config("min", 4))
    assert found.steps == 1
    assert found.inputs == (4, 11, 3), "the inner Theta alone is wrong there"


def test_too_many_combinations_are_refused():
    with pytest.raises(ConfigError, match="membership_bits is 9"):
        operator_error(config("min", 9))


def test_the_documented_table_is_reproduced(project):
    text = (project / "docs" / "operators.md").read_text()
    for operator in ("prod", "soft_min_1"):
        row = re.search(rf"^\| `{operator}` \| ([\d.]+) \(", text, re.MULTILINE)
        assert row, "run make compare"
        assert float(row[1]) == pytest.approx(operator_error(config(operator, 4)).worst, abs=6e-6)
