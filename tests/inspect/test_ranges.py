"""The range of disparities: too small, needless, negative, and the one that would do."""

import numpy as np
import pytest

from softdepth.golden.data.synthetic import generate
from softdepth.inspect.findings import MOST, Finding, needed
from softdepth.inspect.inspection import inspect
from softdepth.inspect.span import Span
from softdepth.inspect.texts import line
from softdepth.spec.config import Config
from tests.inspect.conftest import look, spoilt


def moved(pair, columns: int):
    """The pair with all disparities less by so many columns."""
    return pair.left[:, columns:], pair.right[:, :-columns]


def test_a_range_that_ends_too_early_is_named_with_one_that_would_do(pair):
    found = look(pair.left, pair.right, 12)
    assert spoilt(found) == ["short"]
    assert found.range is not None
    assert (found.range.first, found.range.disparities) == (0, 32)
    assert found.lines[0].endswith("use --disparities 32")
    assert look(pair.left, pair.right, 32).findings == []


def test_the_share_beyond_the_range_is_the_truths(pair):
    truth = pair.truth.disparity[pair.truth.nonoccluded]
    for last in (7, 11, 15):
        found = look(pair.left, pair.right, last + 1)
        assert found.findings[0].figures["share"] == pytest.approx((truth > last).mean(), abs=0.06)


def test_a_range_of_which_half_would_do_is_needless(pair):
    found = look(pair.left, pair.right, 64)
    assert [finding.code for finding in found.findings] == ["needless"]
    assert "--disparities 32 would do" in found.lines[0]
    assert look(pair.left, pair.right, 63).findings == []


def test_negative_disparities_are_told_with_a_range_that_holds_them(pair):
    left, right = moved(pair, 9)  # -8 .. 14
    found = look(left, right, 16)
    assert spoilt(found) == ["negative"]
    assert found.range is not None
    first = found.range.first
    assert -11 <= first <= -8
    assert (
        f"use --set min_disparity={first}, and use --disparities {found.range.disparities}" in found.lines[0]
    )
    config = ["lanes=1", f"min_disparity={first}", f"disparities={found.range.disparities}"]
    again = inspect(left, right, Config.preset("sad").override(config))
    assert again.findings == []
    late = Config.preset("sad").override(["lanes=1", "min_disparity=-3", "disparities=32"])
    assert spoilt(inspect(left, right, late)) == ["negative"]


def test_a_range_that_begins_too_late_names_an_earlier_one(pair):
    config = Config.preset("sad").override(["lanes=1", "min_disparity=8", "disparities=24"])
    found = inspect(pair.left, pair.right, config)
    assert "lie below the first candidate, 8" in found.lines[0]
    assert "--set min_disparity=0" in found.lines[0]


def test_near_scenes_need_more_than_the_default():
    pair = generate("random", width=300, height=150, disparities=20, seed=5)
    left, right = pair.left[:, :-70], pair.right[:, 70:]  # 71 .. 89
    found = look(left, right, 64)
    assert spoilt(found) == ["short"]
    assert found.range is not None
    assert found.range.disparities == 96
    assert look(left, right, 96).findings == []


def span(low: float, high: float) -> Span:
    return Span(np.linspace(low, high, 1000, dtype=np.float32), 1.0)


@pytest.mark.parametrize(("lanes", "candidates"), [(1, 64), (16, 64), (19, 76), (64, 64)])
def test_a_range_is_a_multiple_of_the_lanes(lanes, candidates):
    assert needed(span(3, 59), lanes).disparities == candidates


def test_more_than_a_core_can_have_asks_for_smaller_images():
    would_do = needed(span(0, 500), 16)
    assert would_do.disparities > MOST
    figures = {
        "low": 0,
        "high": 500,
        "given": 64,
        "last": 63,
        "share": 0.9,
        "disparities": would_do.disparities,
    }
    text = line(Finding("short", figures))
    assert "--disparities" not in text
    assert f"{would_do.disparities} candidates are more than {MOST}" in text
