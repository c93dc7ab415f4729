"""The operators of the fixed model: ranges, the denominator's sign, the joining order."""

from itertools import product

import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.costs.fuzzy import operators
from softdepth.golden.costs.fuzzy.fixed_operators import conclude, pair_operator
from softdepth.golden.costs.fuzzy.inference import conclusions, joined_conclusions
from softdepth.golden.costs.fuzzy.operators import FLOAT
from softdepth.spec.config import OPERATORS, Config

SHARPNESSES = (-500.0, -100.0, -1.0, 0.0, 1.0, 30.0, 100.0, 500.0)
SOFTNESSES = (0.0, 0.05, 0.2, 0.4, 0.5, 0.8, 1.0)
HARD = [{"operator": name} for name in ("min", "prod", "mean")]
SOFT_1 = [{"operator": "soft_min_1", "softness": value} for value in SOFTNESSES]
SOFT_2 = [{"operator": "soft_min_2", "sharpness": value} for value in SHARPNESSES]
VANISHING = {"operator": "soft_min_1", "softness": 0.4, "membership_bits": 3}
"""At so few bits, rounding takes some denominators to zero and below."""


def make(bits, **keys):
    """A configuration whose criteria are steps of the memberships, for 4 bits and more."""
    criteria = [{"window": w, "label_bits": max(bits, 4)} for w in (3, 5, 7)]
    limits = {"disparities": 4, "lanes": 1, "max_multipliers": 1000}
    return Config.from_dict({**limits, "criteria": criteria, "membership_bits": bits, **keys})


def every_input(config):
    """Criteria that give all combinations of the three inputs ``0 .. 2 * one``."""
    shift = config.criteria[0].label_bits - config.membership_bits
    steps = np.arange(2 * config.one + 1, dtype=np.int32) << shift
    return [values.ravel() for values in np.meshgrid(steps, steps, steps, indexing="ij")]


def degrees(config, criteria):
    return [
        fixed_model.memberships(c, values, config)
        for c, values in zip(config.criteria, criteria, strict=True)
    ]


def sums(config, criteria):
    """N and S before anything is made of their sign, from the conclusions."""
    found = np.array([y for _, y in conclude(config, degrees(config, criteria))], np.int64)
    return np.arange(5, -6, -1) @ found, found.sum(axis=0)


@pytest.mark.parametrize("bits", [2, 3, 5])
@pytest.mark.parametrize("keys", [*HARD, *SOFT_1, *SOFT_2], ids=str)
def test_strength_range_is_reached_and_never_left(keys, bits):
    config = make(bits, **keys)
    theta = pair_operator(config)
    operands = [v.astype(np.int16) for v in np.meshgrid(*[np.arange(config.one + 1)] * 3, indexing="ij")]
    strength = theta(operands[0], theta(operands[1], operands[2]))
    assert (strength.min(), strength.max()) == config.strength_range


@pytest.mark.parametrize("firing", ["all", "cell"])
@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("bits", [2, 3, 4])
@pytest.mark.parametrize("keys", [*HARD, *SOFT_1, *SOFT_2], ids=str)
def test_cost_range_is_never_left(keys, bits, rules, firing):
    config = make(bits, rules=rules, firing=firing, **keys)
    for values, (low, high) in zip(sums(config, every_input(config)), config.cost_range, strict=True):
        assert low <= values.min() <= values.max() <= high


@pytest.mark.parametrize("bits", [2, 3, 4])
@pytest.mark.parametrize(
    ("keys", "rules"),
    [
        ({"operator": "min"}, "corrected"),
        ({"operator": "mean"}, "corrected"),
        ({"operator": "soft_min_2"}, "corrected"),
        ({"operator": "soft_min_2", "sharpness": -500.0}, "corrected"),
        ({"operator": "mean"}, "printed"),
    ],
    ids=str,
)
def test_the_cost_range_by_cell_is_reached(keys, rules, bits):
    """It is no wider than it must be: the lowest numerator of MEAN alone lies just beyond what occurs."""
    config = make(bits, rules=rules, firing="cell", **keys)
    (n_low, n_high), (_, s_high) = config.cost_range
    n, s = sums(config, every_input(config))
    assert n_low <= n.min() <= n_low + (keys["operator"] == "mean")
    assert (n.max(), s.max()) == (n_high, s_high)


@pytest.mark.parametrize("bits", range(2, 9))
def test_the_strengths_of_prod_sum_to_one_but_for_rounding(bits):
    """Of the criteria's positions in one cell; the others are mirror images of it."""
    config = make(bits, operator="prod", rules="corrected")
    shift = config.criteria[0].label_bits - bits
    steps = np.arange(config.one + 1, dtype=np.int32) << shift
    largest = 0
    for first in steps:
        grid = [v.ravel() for v in np.meshgrid(first, steps, steps)]
        largest = max(largest, sums(config, grid)[1].max())
    assert largest == config.cost_range[1][1] == config.one + 3


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize(
    ("keys", "equal"),
    [
        ({"operator": "min"}, True),
        ({"operator": "prod"}, True),
        ({"operator": "soft_min_1", "softness": 0.0}, True),  # which is MIN
        ({"operator": "soft_min_1", "softness": 0.4}, False),
        ({"operator": "soft_min_2"}, False),
        ({"operator": "soft_min_2", "sharpness": 1.0}, False),
        ({"operator": "mean"}, False),
    ],
    ids=str,
)
def test_rules_outside_the_cell_matter_where_they_have_a_strength(keys, equal, rules):
    apart, together = (make(4, rules=rules, firing=firing, **keys) for firing in ("all", "cell"))
    all_27, of_cell = (np.array(sums(config, every_input(config))) for config in (apart, together))
    assert np.array_equal(all_27, of_cell) == equal
    assert together.by_cell
    assert apart.by_cell == (keys["operator"] in ("min", "prod"))


@pytest.mark.parametrize("firing", ["all", "cell"])
def test_float_and_fixed_rules_fire_in_the_same_cell(firing):
    """MIN and MEAN are exact in both models; criteria lie on labels, and next to them."""
    steps = np.array([0, 1, 15, 16, 17, 31, 32, 33])
    grid = [v.ravel() for v in np.meshgrid(steps, steps, steps, indexing="ij")]
    config = make(4, operator="mean", firing=firing)
    triples = [float_model.memberships(v, 16.0) for v in grid]
    theta = operators.operator("mean", delta=0, k=0)
    exact = dict(conclusions(triples, theta, "printed", firing))
    for k, strength in conclude(config, degrees(config, [v.astype(np.int32) for v in grid])):
        np.testing.assert_allclose(exact[k] * 3 * config.one, strength, atol=1e-9)


@pytest.mark.parametrize("firing", ["all", "cell"])
@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("bits", [2, 3, 4, 5])
@pytest.mark.parametrize("keys", [*HARD, *SOFT_2], ids=str)
def test_the_denominator_is_above_zero(keys, bits, rules, firing):
    """For all inputs there are: the gateware does not look at its sign."""
    config = make(bits, rules=rules, firing=firing, **keys)
    n, s = fixed_model.fraction(config, 0, every_input(config))
    assert s.min() > 0
    assert (abs(n) <= 5 * s).all()  # the cost is a mean of the weights


def test_the_denominator_of_soft_min_1_in_floating_point_is_above_zero():
    """At every softness: that it vanishes in few bits is due to rounding."""
    inputs = [g.ravel() for g in np.meshgrid(*[np.linspace(0, 10000, 25)] * 3, indexing="ij")]
    triples = [float_model.memberships(s, 5000.0) for s in inputs]
    smallest = {}
    for softness in (0.05, 0.3, 0.35, 0.375, 0.4, 0.5, 1.0):
        theta = operators.operator("soft_min_1", delta=softness, k=0)
        smallest[softness] = np.sum([y for _, y in conclusions(triples, theta, "printed")], axis=0).min()
    assert smallest[0.05] == pytest.approx(0.369, abs=0.001)
    assert min(smallest.values()) == smallest[0.375] == pytest.approx(0.0196, abs=0.0001)


@pytest.mark.parametrize("softness", [0.0, 0.05])
@pytest.mark.parametrize("bits", [2, 3, 4, 5])
def test_the_denominator_of_soft_min_1_is_above_zero_at_the_papers_softness(bits, softness):
    config = make(bits, operator="soft_min_1", softness=softness)
    assert sums(config, every_input(config))[1].min() > 0


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("bits", [2, 3, 4])
def test_the_denominator_of_soft_min_1_by_cell_is_above_zero_at_any_softness(bits, rules):
    """So the gateware of a cell does not look at its sign; the least are at about 0.3."""
    found = []
    for softness in np.linspace(0, 1, 41):
        config = make(bits, operator="soft_min_1", softness=float(softness), rules=rules, firing="cell")
        s = sums(config, every_input(config))[1]
        assert s.min() >= config.cost_range[1][0] > 0
        found.append(s.min() / config.one)
    assert min(found) == {2: 0.5 if rules == "printed" else 1.0, 3: 0.25, 4: 0.375}[bits]


@pytest.mark.parametrize("softness", [0.05, 0.25, 0.3, 0.35, 0.5])
@pytest.mark.parametrize("rules", ["printed", "corrected"])
def test_the_denominator_of_soft_min_1_by_cell_is_above_zero_in_many_bits(rules, softness):
    config = make(8, operator="soft_min_1", softness=softness, rules=rules, firing="cell")
    steps = np.array([*range(0, 2 * config.one, 13), 1, 2, *range(255, 259), 511, 512], np.int32)
    grid = [v.ravel() for v in np.meshgrid(steps, steps, steps)]
    assert sums(config, grid)[1].min() > 0.4 * config.one


def test_where_the_denominator_vanishes_the_cost_is_one_over_zero():
    config = make(3, **{k: v for k, v in VANISHING.items() if k != "membership_bits"})
    criteria = every_input(config)
    expected_n, expected_s = sums(config, criteria)
    vanished = expected_s <= 0
    assert vanished.sum() == 140
    assert (expected_s[vanished] < 0).any()
    n, s = fixed_model.fraction(config, 0, criteria)
    assert set(zip(n[vanished].tolist(), s[vanished].tolist(), strict=True)) == {(1, 0)}
    np.testing.assert_array_equal(n[~vanished], expected_n[~vanished])
    np.testing.assert_array_equal(s[~vanished], expected_s[~vanished])


def test_an_infinite_cost_wins_only_against_its_like():
    """In the fixed model's map, against the traces of its pixels."""
    config = make(3, operator="soft_min_1", softness=0.4)
    config = config.override([f"criteria.{i}.label_bits={bits}" for i, bits in enumerate((6, 8, 8))])
    rng = np.random.default_rng(4)
    left = rng.integers(0, 12, (9, 40, 3), dtype=np.uint8)
    right = rng.integers(0, 12, (9, 40, 3), dtype=np.uint8)
    result = fixed_model.disparity(left, right, config)
    infinite = 0
    for y, x in np.argwhere(result.valid):
        trace = fixed_model.trace(left, right, config, x, y)
        fractions = list(zip(trace.numerator.tolist(), trace.denominator.tolist(), strict=True))
        costs = [n / s if s else np.inf for n, s in fractions]
        infinite += np.isinf(costs).any()
        assert result.disparity[y, x] == np.argmin(costs)
    assert infinite > 10


def test_a_vanishing_sum_is_infinite_in_floating_point():
    """No operator of the paper gets there; one that does loses against any other candidate."""

    def shifted(a, b, c):
        return np.minimum(np.minimum(a, b), c) - 0.1

    config = make(8)
    left, right = np.zeros((2, 7, 12, 3), np.uint8)
    right[:, 8:] = 40
    with FLOAT.scope(without={config.operator}):
        FLOAT.register(config.operator, lambda delta, k: shifted)
        curve = float_model.costs(left, right, config, 8, 3, label=900.0)
        result = float_model.disparity(left, right, config, label=900.0)
    assert np.isinf(curve).any()
    assert np.isfinite(curve).any()
    assert result.disparity[3, 8] == curve.argmin()


@pytest.mark.parametrize("rules", ["printed", "corrected"])
@pytest.mark.parametrize("keys", [*HARD, *SOFT_1], ids=str)
@pytest.mark.parametrize("firing", ["all", "cell"])
def test_monotone_operators_may_be_joined_before_theta(keys, rules, firing):
    config = make(4, rules=rules, firing=firing, **keys)
    triples = degrees(config, every_input(config))
    joined = dict(joined_conclusions(triples, pair_operator(config), rules, firing))
    for k, strength in conclude(config, triples):
        np.testing.assert_array_equal(strength, joined[k])


@pytest.mark.parametrize("sharpness", [-10.0, 10.0])
def test_soft_min_2_is_joined_before_theta_and_this_matters(sharpness):
    """Its result is not that of all rules by themselves, which is why the order is laid down."""
    config = make(5, operator="soft_min_2", sharpness=sharpness)
    theta = pair_operator(config)
    triples = degrees(config, every_input(config))
    apart = dict(conclusions(triples, lambda a, b, c: theta(a, theta(b, c)), "printed"))
    differing = 0
    for k, strength in conclude(config, triples):
        differing += np.count_nonzero(strength != apart[k])
        assert (strength <= apart[k]).all()
    assert differing > 0


@pytest.mark.parametrize("sharpness", SHARPNESSES)
def test_soft_min_2_is_bounded_by_its_operands(sharpness):
    config = make(5, operator="soft_min_2", sharpness=sharpness)
    a, b = (v.astype(np.int16) for v in np.meshgrid(*[np.arange(33)] * 2))
    strength = pair_operator(config)(a, b)
    assert (np.minimum(a, b) <= strength).all()
    assert (strength <= np.maximum(a, b)).all()


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("softness", [0.05, 0.5])
def test_nothing_overflows_at_the_widest_memberships(operator, softness):
    """The arrays' narrow types against Python's integers, at the extremes of the range."""
    config = make(12, operator=operator, softness=softness)
    theta = pair_operator(config)
    values = [0, 1, 2047, 2048, 4095, 4096]
    steps = np.array(values) << (config.criteria[0].label_bits - config.membership_bits)
    low, middle, _ = fixed_model.memberships(config.criteria[0], steps.astype(np.int32), config)
    for x, y, z in product(range(len(values)), repeat=3):
        a, b, c = middle[x : x + 1], middle[y : y + 1], low[z : z + 1]
        exact = theta(a.astype(np.int64), theta(b.astype(np.int64), c.astype(np.int64)))
        assert theta(a, theta(b, c)) == exact
