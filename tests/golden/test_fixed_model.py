"""The fixed model: borders, exclusion, ties, compensation, trace, errors."""

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.costs.candidates import bands
from softdepth.spec.config import OPERATORS, Config
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

SOFT = {"operator": "soft_min_1", "softness": 0.5}  # where a cost may be infinite


def make(**keys):
    return Config.from_dict({"disparities": 8, "lanes": 1, **keys})


def noise(height, width, seed=0):
    return np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)


def shifted_pair(height, width, shift, seed=0):
    """A pair whose disparity is `shift` everywhere."""
    scene = noise(height, width + shift, seed)
    return scene[:, :width], scene[:, shift:]


@pytest.mark.parametrize("shift", [0, 1, 5, 7])
@pytest.mark.parametrize("operator", OPERATORS)
def test_a_shifted_scene_gives_its_shift(shift, operator):
    config = make(operator=operator)
    left, right = shifted_pair(20, 40, shift)
    result = fixed_model.disparity(left, right, config)
    comparable = result.valid.copy()
    comparable[:, : 3 + shift] = False  # here the true candidate is excluded
    assert comparable.any()
    assert (result.disparity[comparable] == shift).all()


def test_codes_follow_the_border_rule():
    config = make(criteria=[{"window": 3, "dx": 2}, {"window": 5, "dx": -3}, {"window": 7}])
    left, right = noise(12, 30), noise(12, 30, 1)
    code = fixed_model.disparity(left, right, config).code
    assert (config.reach_left, config.reach_right, config.reach_rows) == (5, 3, 3)
    assert (code[:3] == Validity.BORDER).all()
    assert (code[-3:] == Validity.BORDER).all()
    expected = [Validity.BORDER] * 5 + [Validity.PARTIAL] * 7 + [Validity.FULL] * 15 + [Validity.BORDER] * 3
    assert (code[3:-3] == expected).all()


def test_border_has_disparity_zero():
    result = fixed_model.disparity(noise(12, 30), noise(12, 30, 1), make())
    assert not result.disparity[~result.valid].any()
    assert result.disparity[result.valid].any()


def test_excluded_candidates_never_win():
    result = fixed_model.disparity(*shifted_pair(12, 30, 7), make())
    room = np.arange(30) - 3
    assert (result.disparity <= np.maximum(room, 0)).all()
    assert (result.disparity[3:-3, 3:10] < 7).all()
    assert (result.disparity[3:-3, 10:-3] == 7).all()


@pytest.mark.parametrize("cost", ["fuzzy", "sum"])
def test_a_tie_goes_to_the_smallest_disparity(cost):
    config = make(cost=cost) if cost == "fuzzy" else make(cost=cost, criteria=[{"window": 3}])
    flat = np.full((12, 30, 3), 77, np.uint8)
    assert not fixed_model.disparity(flat, flat, config).disparity.any()
    period = np.tile(noise(12, 3), (1, 10, 1))  # repeats every 3 pixels: 1, 4 and 7 tie
    result = fixed_model.disparity(period, np.roll(period, -1, axis=1), config)
    inner = result.disparity[3:-3, 5:-4]
    assert (inner == 1).all()


def test_saturated_costs_tie():
    config = make(criteria=[{"window": w, "label_bits": 4} for w in (3, 5, 7)], membership_bits=4)
    black, white = np.zeros((12, 30, 3), np.uint8), np.full((12, 30, 3), 255, np.uint8)
    assert not fixed_model.disparity(black, white, config).disparity.any()


@pytest.mark.parametrize(("height", "width"), [(1, 1), (6, 30), (12, 6), (7, 6), (6, 7)])
def test_smaller_than_the_support_is_all_border(height, width):
    result = fixed_model.disparity(noise(height, width), noise(height, width), make())
    assert result.shape == (height, width)
    assert (result.code == Validity.BORDER).all()
    assert not result.disparity.any()


def test_the_smallest_image_has_one_result():
    result = fixed_model.disparity(noise(7, 7), noise(7, 7, 1), make())
    assert np.argwhere(result.valid).tolist() == [[3, 3]]
    assert result.code[3, 3] == Validity.PARTIAL


def test_bands_do_not_show(monkeypatch):
    left, right = shifted_pair(33, 41, 4)
    right = right // 2 + noise(33, 41, 2) // 2
    whole = fixed_model.disparity(left, right, make())
    monkeypatch.setattr("softdepth.golden.costs.candidates.BAND_PIXELS", 41 * 4)
    assert len(list(bands(left, right, make()))) == 7
    assert list(whole.differences(fixed_model.disparity(left, right, make()))) == []


def test_right_reference_is_left_of_the_mirrored_pair():
    left, right = shifted_pair(14, 30, 5)
    got = fixed_model.disparity(left, right, make(reference="right"))
    mirrored = fixed_model.disparity(right[:, ::-1], left[:, ::-1], make())
    assert list(mirrored.mirrored().differences(got)) == []
    assert (got.disparity[3:-3, 3:-8] == 5).all()


def near_pair():
    """A false near match: d = 40 fits best by far, but its SAD3 is 27 * 50 = 1350."""
    left, right = shifted_pair(9, 90, 40)
    return left // 128 * 200, right // 128 * 200 + 50


def near_config(reading):
    return make(disparities=64, compensation={"reading": reading})


def test_compensation_top_removes_a_false_near_match():
    left, right = near_pair()
    off, top = (fixed_model.disparity(left, right, near_config(r)).disparity for r in ("off", "top"))
    full = np.s_[3:-3, 66:-3]
    assert (off[full] == 40).all()
    assert (top[full] < 32).all()


def test_compensation_literal_makes_far_candidates_look_good():
    left, right = near_pair()
    literal = fixed_model.disparity(left, right, near_config("literal")).disparity
    # 1000 is less than the sums it replaces: candidates from 32 on tie, and the first of them wins.
    assert (literal[3:-3, 66:-3] == 32).all()


@pytest.mark.parametrize(("reading", "inserted"), [("top", 8192), ("literal", 1000)])
def test_compensation_replaces_all_criteria_from_from_disparity_on(reading, inserted):
    left, right = near_pair()
    trace = fixed_model.trace(left, right, near_config(reading), 80, 4)
    fires = (np.arange(64) >= 32) & (trace.criteria[:, 0] > 1200)
    assert 20 < fires.sum() <= 32
    assert (trace.inputs[fires] == inserted).all()
    assert (trace.inputs[~fires] == trace.criteria[~fires]).all()


def test_compensation_threshold_is_exclusive():
    left, right = np.zeros((2, 7, 10, 3), np.uint8)
    right[3, 3:, 0] = 40  # SAD3 of the middle row: three pixels of 40
    for threshold, expected in ((119, 8192), (120, 120)):
        config = make(compensation={"reading": "top", "threshold": threshold, "from_disparity": 0})
        assert fixed_model.trace(left, right, config, 5, 3).inputs[0, 0] == expected


@pytest.mark.parametrize("reference", ["left", "right"])
@pytest.mark.parametrize(
    "keys", [{}, {"operator": "min"}, SOFT, {"cost": "sum", "criteria": [{"window": 5}]}]
)
def test_trace_agrees_with_the_map(reference, keys):
    left, right = noise(9, 22), noise(9, 22, 1)
    config = make(reference=reference, **keys)
    result = fixed_model.disparity(left, right, config)
    for y in range(9):
        for x in range(22):
            trace = fixed_model.trace(left, right, config, x, y)
            assert (trace.disparity, trace.code, trace.confidence) == result.at(x, y)
            assert (len(trace.numerator) == 0) == (trace.code == Validity.BORDER)


def test_trace_shows_every_stage_of_a_worked_pixel():
    """Criteria 27, 75, 147 at T = 64 and one = 64; labels and rules worked out by hand."""
    left, right = np.zeros((7, 7, 3), np.uint8), np.ones((7, 7, 3), np.uint8)
    config = make(
        operator="mean", membership_bits=6, criteria=[{"window": w, "label_bits": 6} for w in (3, 5, 7)]
    )
    trace = fixed_model.trace(left, right, config, 3, 3)
    assert trace.criteria.tolist() == [[27, 75, 147]]
    low_mid_high = [[37, 27, 0], [0, 53, 11], [0, 0, 64]]  # u = 27, 75, and 128 = 2T saturated
    assert trace.memberships.tolist() == [low_mid_high]
    y = [
        0 + 11 + 64,  # Y1: 333
        max(0 + 11 + 0, 0 + 53 + 64),  # Y2: 332 323
        max(0 + 11 + 0, 0 + 53 + 0, 0 + 0 + 64),  # Y3: 331 322 313
        max(0, 0, 0 + 53 + 0),  # Y4: 311 312 321
        max(27 + 53 + 64, 27 + 11 + 0, 27 + 11 + 64),  # Y5: 223 232 233
        max(27 + 0 + 64, 27 + 53 + 0, 27 + 11 + 0),  # Y6: 213 222 231
        max(37 + 11 + 64, 27 + 0 + 0, 27 + 53 + 0),  # Y7: 133 212 221
        max(37 + 53 + 64, 37 + 11 + 0, 27 + 0 + 0),  # Y8: 123 132 211
        max(37 + 0 + 64, 37 + 53 + 0, 37 + 11 + 0),  # Y9: 113 122 131
        max(37 + 0 + 0, 37 + 53 + 0),  # Y10: 112 121
        37 + 0 + 0,  # Y11: 111
    ]
    assert trace.conclusions.tolist() == [y]
    assert trace.denominator.tolist() == [sum(y)]
    assert trace.numerator.tolist() == [sum(v * w for v, w in zip(y, range(5, -6, -1), strict=True))]
    assert "0: [ 27  75 147]" in str(trace)


@pytest.mark.parametrize("label_bits", [4, 8, 13])
@pytest.mark.parametrize("membership_bits", [2, 3, 8, 12])
def test_memberships_sum_to_one_and_two_at_most_are_alive(label_bits, membership_bits):
    label_bits = max(label_bits, membership_bits)
    config = make(membership_bits=membership_bits, criteria=[{"window": 3, "label_bits": label_bits}] * 3)
    s = np.arange(0, (2 << label_bits) + 50, dtype=np.int32)
    low, middle, high = fixed_model.memberships(config.criteria[0], s, config)
    assert (low + middle + high == config.one).all()
    assert min(low.min(), middle.min(), high.min()) == 0
    assert not (low * high).any()
    at = 1 << label_bits
    assert (low[0], middle[at], high[2 * at], high[-1]) == (config.one,) * 4


def test_integer_is_the_smallest_type_that_holds_both_signs():
    assert [fixed_model.integer(m).name for m in (127, 128, 32767, 32768, 2**31 - 1, 2**31)] == [
        "int8", "int16", "int16", "int32", "int32", "int64",
    ]  # fmt: skip


def test_too_wide_an_image_is_refused():
    config = make(max_width=32)
    assert fixed_model.disparity(noise(9, 32), noise(9, 32), config).valid.any()
    for call in (fixed_model.disparity, lambda *a: fixed_model.trace(*a, x=0, y=0)):
        with pytest.raises(InputError, match=r"33 pixels wide.*max_width = 32"):
            call(noise(9, 33), noise(9, 33), config)


@pytest.mark.parametrize(("x", "y"), [(-1, 0), (9, 0), (0, -1), (0, 8)])
def test_trace_outside_the_image_is_refused(x, y):
    with pytest.raises(InputError, match=f"x={x} y={y}.*9x8"):
        fixed_model.trace(noise(8, 9), noise(8, 9), make(), x, y)
