"""The operators and the rule base by their defining properties."""

import itertools
import math

import numpy as np
import pytest

from softdepth.golden.costs.fuzzy.inference import conclusions
from softdepth.golden.costs.fuzzy.operators import operator
from softdepth.spec.rules import rule_base, weight

GRID = [np.array(v) for v in zip(*itertools.product(np.linspace(0, 1, 11), repeat=3), strict=True)]
NAMES = ["min", "prod", "mean", "soft_min_1", "soft_min_2"]


def apply(name, a=GRID[0], b=GRID[1], c=GRID[2], *, delta=0.05, k=-100.0):
    return operator(name, delta=delta, k=k)(a, b, c)


def test_hard_operators_are_numpys_reductions():
    np.testing.assert_array_equal(apply("min"), np.min(GRID, axis=0))
    np.testing.assert_allclose(apply("prod"), np.prod(GRID, axis=0), rtol=1e-15)
    np.testing.assert_allclose(apply("mean"), np.mean(GRID, axis=0), rtol=1e-15)


def test_soft_min_1_is_min_within_its_softness():
    np.testing.assert_allclose(apply("soft_min_1", delta=0.0), apply("min"), atol=1e-15)
    difference = apply("soft_min_1") - apply("min")
    assert -2 * (0.05 - 0.05**2) / 2 <= difference.min() < -0.02
    assert difference.max() <= 0.05**2
    inner = (0.65 + 0.0025 - math.sqrt(0.0025 + 0.0025)) / 2
    got = apply("soft_min_1", *(np.array([v]) for v in (inner, 0.3, 0.35)))
    assert got == pytest.approx((2 * inner + 0.0025 - 0.05) / 2)


@pytest.mark.parametrize(
    ("k", "limit"), [(100.0, np.min), (-100.0, np.max), (500.0, np.min), (-500.0, np.max)]
)
def test_soft_min_2_leans_to_the_side_of_k(k, limit):
    # Two operands x away from the limit err most: 2*x*exp(-k*x) / (1 + 2*exp(-k*x)) < 0.47 / k.
    error = apply("soft_min_2", k=k) - limit(GRID, axis=0)
    assert np.abs(error).max() <= 0.47 / abs(k)
    assert (error * k >= -1e-12).all()


def test_soft_min_2_without_steepness_is_the_mean():
    np.testing.assert_allclose(apply("soft_min_2", k=0.0), apply("mean"), rtol=1e-15)


@pytest.mark.parametrize("name", NAMES)
def test_three_equal_operands(name):
    x = np.linspace(0, 1, 11)
    got = apply(name, x, x, x)
    if name == "prod":
        np.testing.assert_allclose(got, x**3)
    elif name == "soft_min_1":
        assert (np.abs(got - x) < 0.04).all()
    else:
        np.testing.assert_allclose(got, x, atol=1e-15)


@pytest.mark.parametrize("name", ["printed", "corrected"])
def test_the_rule_base_is_a_partition(name):
    rules = [rule for members in rule_base(name).values() for rule in members]
    assert sorted(rules) == list(itertools.product((1, 2, 3), repeat=3))
    assert list(rule_base(name)) == list(range(1, 12))


def test_only_the_corrected_rule_base_follows_one_weighting():
    """Against 3*(3-a) + (3-b) + (3-c), a higher conclusion must never hold a lower weighting."""

    def inversions(name):
        spans = [
            [3 * (3 - a) + (3 - b) + (3 - c) for a, b, c in members] for members in rule_base(name).values()
        ]
        return sum(max(before) > min(after) for before, after in itertools.pairwise(spans))

    assert inversions("printed") > 0
    assert inversions("corrected") == 0


def test_weights_fall_linearly_about_zero():
    assert [weight(k) for k in range(1, 12)] == [5, 4, 3, 2, 1, 0, -1, -2, -3, -4, -5]


@pytest.mark.parametrize("name", ["printed", "corrected"])
def test_a_single_fully_met_rule_names_its_conclusion(name):
    """With crisp memberships exactly one rule fires, and its class is read off the table."""
    theta = operator("min", delta=0.05, k=-100)

    def as_array(value):
        return np.array([value], float)

    for labels in itertools.product((1, 2, 3), repeat=3):
        crisp = [(as_array(label == 1), as_array(label == 2), as_array(label == 3)) for label in labels]
        fired = [k for k, y_k in conclusions(crisp, theta, name) if y_k == 1]
        assert fired == [k for k, members in rule_base(name).items() if labels in members]
