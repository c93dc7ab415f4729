"""The float model against the paper's equations, written out in plain Python."""

import math

import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError, InputError
from softdepth.spec.validity import Validity

OPERATORS = ["min", "prod", "mean", "soft_min_1", "soft_min_2"]
# Table 1 as printed, row by row: labels of criteria 1, 2, 3.
PRINTED = "333|332 323|331 322 313|311 312 321|" + (
    "223 232 233|213 222 231|133 212 221|123 132 211|113 122 131|112 121|111"
)


def make(**keys):
    return Config.from_dict({"disparities": 6, "lanes": 1, **keys})


def noise(height, width, seed=0, top=256):
    return np.random.default_rng(seed).integers(0, top, (height, width, 3), dtype=np.uint8)


def eq_5(a, b, delta):
    return (a + b + delta**2 - math.sqrt((a - b) ** 2 + delta**2)) / 2


def eq_6(operands, k):
    return sum(a * math.exp(-k * a) for a in operands) / sum(math.exp(-k * a) for a in operands)


def eq_7(left, right, x, y, d, window):
    """In the left view: the paper's x + d becomes x - d."""
    r = window // 2
    return sum(
        abs(int(left[y + n, x + m, channel]) - int(right[y + n, x + m - d, channel]))
        for m in range(-r, r + 1)
        for n in range(-r, r + 1)
        for channel in range(3)
    )


def eq_9(s, t):
    s = min(s, 2 * t)
    a1 = (t - s) / t if s < t else 0
    a2 = s / t if s < t else (2 * t - s) / t
    a3 = (s - t) / t if s > t else 0
    return {"1": a1, "2": a2, "3": a3}


def eq_10(inputs, operator, *, label=5000, delta=0.05, k=-100):
    theta = {
        "min": lambda a, b, c: min(a, b, c),
        "prod": lambda a, b, c: a * b * c,
        "mean": lambda a, b, c: (a + b + c) / 3,
        "soft_min_1": lambda a, b, c: eq_5(a, eq_5(b, c, delta), delta),
        "soft_min_2": lambda a, b, c: eq_6((a, b, c), k),
    }[operator]
    a = [eq_9(s, label) for s in inputs]
    y = [max(theta(*(a[i][rule[i]] for i in range(3))) for rule in row.split()) for row in PRINTED.split("|")]
    return sum(m * y_k for m, y_k in zip(range(10, -1, -1), y, strict=True)) / sum(y)


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("settings", [{}, {"label": 900.0, "delta": 0.2, "k": 30.0}])
@pytest.mark.parametrize("top", [40, 256])
def test_costs_follow_the_equations(operator, settings, top):
    left, right = noise(9, 16, 0, top), noise(9, 16, 1, top)
    config = make(operator=operator)
    for x, y in ((3, 3), (6, 4), (12, 5)):
        expected = [
            eq_10([eq_7(left, right, x, y, d, w) for w in (3, 5, 7)], operator, **settings)
            for d in range(6)
            if x - 3 - d >= 0
        ]
        got = float_model.costs(left, right, config, x, y, **settings)
        np.testing.assert_allclose(got[: len(expected)], expected, rtol=1e-12)
        assert np.isinf(got[len(expected) :]).all()
        assert got.shape == (6,)


@pytest.mark.parametrize(("reading", "inserted"), [("top", 10000), ("literal", 1000)])
def test_compensated_costs_follow_the_rule(reading, inserted):
    left, right = noise(7, 16), noise(7, 16, 1)
    config = make(compensation={"reading": reading, "threshold": 2300, "from_disparity": 2})
    got = float_model.costs(left, right, config, 12, 3)
    fired = 0
    for d in range(6):
        s = [eq_7(left, right, 12, 3, d, w) for w in (3, 5, 7)]
        if d >= 2 and s[0] > 2300:
            s = [inserted] * 3
            fired += 1
        assert got[d] == pytest.approx(eq_10(s, "mean"), rel=1e-12)
    assert 0 < fired < 4


@pytest.mark.parametrize("reference", ["left", "right"])
@pytest.mark.parametrize("operator", OPERATORS)
def test_disparity_is_the_first_minimum_of_the_costs(operator, reference):
    left, right = noise(10, 18), noise(10, 18, 1)
    config = make(operator=operator, reference=reference)
    result = float_model.disparity(left, right, config)
    for y in range(10):
        for x in range(18):
            curve = float_model.costs(left, right, config, x, y)
            if result.code[y, x] == Validity.BORDER:
                assert np.isinf(curve).all()
                assert result.disparity[y, x] == 0
            else:
                assert result.disparity[y, x] == curve.argmin()
                excluded = int(np.isinf(curve).sum())
                assert (excluded > 0) == (result.code[y, x] == Validity.PARTIAL)


@pytest.mark.parametrize("operator", OPERATORS)
def test_a_tie_goes_to_the_smallest_disparity(operator):
    flat = np.full((9, 20, 3), 90, np.uint8)
    assert not float_model.disparity(flat, flat, make(operator=operator)).disparity.any()
    period = np.tile(noise(9, 3), (1, 8, 1))  # repeats every 3 pixels: 1 and 4 tie
    result = float_model.disparity(period, np.roll(period, -1, axis=1), make(operator=operator))
    assert (result.disparity[3:-3, 5:-4] == 1).all()


def test_literal_and_top_differ_from_off_in_the_map():
    left, right = noise(20, 30), noise(20, 30, 1)
    maps = [
        float_model.disparity(
            left, right, make(compensation={"reading": r, "threshold": 2300, "from_disparity": 2})
        ).disparity
        for r in ("off", "top", "literal")
    ]
    assert maps[1].mean() < maps[0].mean() < maps[2].mean()


def test_memberships_sum_to_one():
    s = np.arange(0, 12000, 7)
    low, middle, high = float_model.memberships(s, 5000.0)
    np.testing.assert_allclose(low + middle + high, 1, atol=1e-15)
    assert min(low.min(), middle.min(), high.min()) == 0
    expected = np.array([list(eq_9(v, 5000).values()) for v in s.tolist()])
    np.testing.assert_allclose(np.transpose([low, middle, high]), expected, atol=1e-15)


def test_sad_cost_is_the_first_criterion():
    left, right = noise(9, 16), noise(9, 16, 1)
    config = make(cost="sum", criteria=[{"window": 5}])
    got = float_model.costs(left, right, config, 10, 4)
    assert got.tolist() == [eq_7(left, right, 10, 4, d, 5) for d in range(6)]
    same = fixed_model.disparity(left, right, config)
    assert list(same.differences(float_model.disparity(left, right, config))) == []


@pytest.mark.parametrize("rules", ["printed", "corrected"])
def test_min_equals_the_fixed_model_where_both_are_exact(rules):
    """With T = 4096 the float memberships are dyadic; only the division rounds, far below a tie."""
    config = make(operator="min", membership_bits=12, rules=rules)
    left, right = noise(30, 60), noise(30, 60, 1, 128)
    expected = fixed_model.disparity(left, right, config)
    got = float_model.disparity(left, right, config, label=4096.0)
    assert list(expected.differences(got)) == []


def test_any_width_is_accepted():
    config = make(max_width=16)
    assert float_model.disparity(noise(9, 40), noise(9, 40), config).valid.any()


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"label": 0.0}, r"label is 0\.0"),
        ({"label": math.inf}, "label is inf"),
        ({"label": math.nan}, "label is nan"),
        ({"delta": -0.1}, r"delta is -0\.1"),
        ({"k": 1000.0}, r"k is 1000\.0"),
        ({"k": math.nan}, "k is nan"),
    ],
)
def test_settings_out_of_range_are_refused(settings, message):
    with pytest.raises(ConfigError, match=message):
        float_model.disparity(noise(9, 16), noise(9, 16), make(), **settings)


def test_a_pixel_outside_is_refused():
    with pytest.raises(InputError, match=r"x=16 y=0.*16x9"):
        float_model.costs(noise(9, 16), noise(9, 16), make(), 16, 0)
