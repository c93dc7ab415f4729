"""What is said about pairs that are broken in one way each, and about sound ones."""

import numpy as np
import pytest

from softdepth.golden.data.synthetic import generate
from softdepth.studies.broken import curved, pale, scaled, turned
from tests.inspect.conftest import look, spoilt


def figures(found, code):
    return next(finding.figures for finding in found.findings if finding.code == code)


@pytest.mark.parametrize("scene", ["plane", "steps", "slanted", "random"])
def test_a_sound_pair_is_not_accused(scene):
    pair = generate(scene, width=240, height=160, disparities=24, seed=3)
    found = look(pair.left, pair.right, 24)
    assert found.findings == []
    assert found.measured.bare < 0.1
    assert found.measured.rows is not None
    assert abs(found.measured.rows.offset) < 0.1


def test_gray_pairs_are_measured_as_coloured_ones(pair):
    left, right = (np.repeat(view[:, :, 1:2], 3, axis=2) for view in (pair.left, pair.right))
    assert look(left, right).json() == look(left[:, :, 0], right[:, :, 0]).json()


def test_exchanged_views_are_named_with_the_range_of_the_right_order(pair):
    found = look(pair.right, pair.left, 16)
    assert spoilt(found) == ["exchanged"]
    assert figures(found, "exchanged")["share"] > 0.95
    assert found.range is not None
    assert (found.range.first, found.range.disparities) == (0, 32)
    assert "give the right image first, and use --disparities 32" in found.lines[0]
    assert "use --disparities" not in look(pair.right, pair.left, 64).lines[0]


@pytest.mark.parametrize("offset", [-16, -7, -1, 1, 2, 16])
def test_rows_that_are_off_are_counted(pair, offset):
    n = abs(offset)
    views = (pair.left[:-n], pair.right[n:]) if offset < 0 else (pair.left[n:], pair.right[:-n])
    found = look(*views)
    assert spoilt(found) == ["rows"]
    assert figures(found, "rows")["offset"] == pytest.approx(offset, abs=0.1)
    first, second = ("left", "right") if offset < 0 else ("right", "left")
    assert f"cut {n} rows off the {first} image's top and off the {second} image's bottom" in found.lines[0]


@pytest.mark.parametrize("offset", [-5, 5])
def test_the_remedy_for_rows_helps(pair, offset):
    views = (pair.left[:-5], pair.right[5:]) if offset < 0 else (pair.left[5:], pair.right[:-5])
    line = look(*views).lines[0]
    top, bottom = (views[0], views[1]) if "off the left image's top" in line else (views[1], views[0])
    cut = (top[5:], bottom[:-5])
    assert spoilt(look(*(cut if top is views[0] else cut[::-1]))) == []


@pytest.mark.parametrize("degrees", [-1.0, -0.5, 0.5, 1.0])
def test_a_turned_view_is_not_rectified(degrees):
    pair = generate("random", width=360, height=200, disparities=24, seed=1)
    found = look(pair.left, turned(pair.right, degrees))
    assert spoilt(found) == ["unrectified"]
    assert abs(figures(found, "unrectified")["degrees"]) == pytest.approx(abs(degrees), abs=0.1)


@pytest.mark.parametrize(
    ("change", "ratio"), [(lambda v: scaled(v, 0.7), 0.7), (lambda v: scaled(v, 1.2), 1.2)]
)
def test_another_brightness_is_measured(pair, change, ratio):
    found = look(pair.left, change(pair.right))
    assert spoilt(found) == ["brightness"]
    assert figures(found, "brightness")["ratio"] == pytest.approx(ratio, rel=0.03)


@pytest.mark.parametrize("gamma", [1.5, 1 / 1.5])
def test_another_gamma_shows_as_brightness(pair, gamma):
    assert spoilt(look(pair.left, curved(pair.right, gamma))) == ["brightness"]


def test_another_contrast_at_equal_brightness_is_named(pair):
    right = scaled(128 + (pair.right.astype(float) - 128) * 0.7, 1)
    found = look(pair.left, right)
    assert spoilt(found) == ["contrast"]
    assert figures(found, "contrast")["ratio"] == pytest.approx(0.7, abs=0.03)


def test_a_lamp_on_one_side_is_uneven_light(pair):
    lamp = np.linspace(0.7, 1.4, pair.width)[None, :, None]
    assert "uneven" in spoilt(look(pair.left, scaled(pair.right * lamp, 1)))


def test_a_picture_without_texture_has_nothing_to_match(pair):
    found = look(pale(pair.left), pale(pair.right))
    assert spoilt(found) == ["bare"]
    assert figures(found, "bare")["share"] > 0.99


@pytest.mark.parametrize("value", [0, 255])
def test_an_empty_picture_has_nothing_to_match(value):
    empty = np.full((60, 80, 3), value, np.uint8)
    other = empty.copy()
    other[0, 0] = 99
    assert spoilt(look(empty, other)) == ["bare"]


def test_views_of_two_scenes_have_nothing_in_common(pair, other):
    assert spoilt(look(pair.left, other.right)) == ["unmatched"]


def test_one_picture_twice_is_told(pair):
    assert spoilt(look(pair.left, pair.left.copy())) == ["same"]


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (40, 1), (4, 4), (12, 2000)])
def test_any_size_is_inspected(shape):
    rng = np.random.default_rng(0)
    left, right = (rng.integers(0, 256, (*shape, 3), dtype=np.uint8) for _ in range(2))
    assert look(left, right).measured.width == shape[1]
