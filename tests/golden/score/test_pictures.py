"""Pictures: colours mean what the legend says."""

import io

import matplotlib
import numpy as np
import pytest
from PIL import Image

from softdepth.golden.data.truth import from_disparity
from softdepth.golden.score.pictures import (
    CODE_COLOURS,
    ERROR_COLOURS,
    NO_RESULT,
    code_picture,
    colour,
    colour_range,
    error_picture,
)
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity


def test_near_is_warm_and_far_is_cold() -> None:
    picture = colour(np.array([[6, 32, 58]]), np.ones((1, 3), bool), 64)[0].astype(int)
    far, middle, near = picture
    assert far[2] > far[0] + 100, "far is blue"
    assert middle[1] == middle.max(), "the middle is green"
    assert near[0] > near[2] + 100, "near is red"
    assert picture.shape == (3, 3)


def test_colours_are_the_maps_own() -> None:
    """Matplotlib has the same map in a table of its own; its darkest tenth is left out."""
    expected = 255 * matplotlib.colormaps["turbo"](np.linspace(0.1, 1, 256))[:, :3]
    actual = colour(np.arange(256)[np.newaxis] + 0.5, np.ones((1, 256), bool), 256)[0]
    assert np.abs(actual - expected).max() <= 1


def luminance(rgb: np.ndarray | tuple[int, int, int]) -> float:
    return float(np.asarray(rgb, float) @ (0.2126, 0.7152, 0.0722))


def test_disparity_0_is_no_darkness() -> None:
    """At a glance: bright blue against near black, wherever the scale begins."""
    for minimum in (0, -8):
        zero, nothing = colour(np.array([[minimum, 9]]), np.array([[True, False]]), 64, minimum=minimum)[0]
        assert tuple(nothing) == NO_RESULT
        assert luminance(zero) > luminance(nothing) + 50
        assert zero[2] > 150


def test_no_disparity_has_the_look_of_another_code() -> None:
    """Full, partial and filled results of any disparity are far from each other and from no result."""
    ramp = np.linspace(0, 64, 65)[np.newaxis]
    valid = np.ones(ramp.shape, bool)
    full, partial, filled = (
        colour(ramp, valid, 64, code=np.full(ramp.shape, code))[0].astype(int)
        for code in (Validity.FULL, Validity.PARTIAL, Validity.FILLED)
    )
    assert np.abs(full - partial).max(1).min() > 60
    assert np.abs(full - filled).max(1).min() > 30
    assert np.abs(partial - filled).max(1).min() > 40
    for shades in (partial, filled):
        assert np.abs(shades - NO_RESULT).max(1).min() > 80


def test_range_fits_what_is_there() -> None:
    disparity = np.full((40, 50), 20.0)
    disparity[:, 25:] = 33.5
    valid = np.ones(disparity.shape, bool)
    disparity[0, 0], disparity[0, 1] = 0, 63  # a few wrong ones
    disparity[1, :2] = np.nan, 99
    valid[1, 1] = False
    assert colour_range(disparity, valid) == (20, 34)
    assert colour_range(-disparity, valid) == (-34, -20)
    assert colour_range(np.full((3, 3), 7), np.ones((3, 3), bool)) == (7, 8)
    assert colour_range(disparity, np.zeros_like(valid)) == (0, 1)


def test_codes_can_be_read_back_and_seen() -> None:
    code = np.arange(7, dtype=np.uint8)[np.newaxis].repeat(3, 0)
    image = Image.open(io.BytesIO(code_picture(code)))
    assert image.mode == "P"
    np.testing.assert_array_equal(np.asarray(image), code)
    np.testing.assert_array_equal(np.asarray(image.convert("RGB"))[0], [CODE_COLOURS[c] for c in Validity])
    assert set(CODE_COLOURS) == set(Validity)
    assert len(set(CODE_COLOURS.values())) == len(Validity)


@pytest.mark.parametrize(("low", "high"), [(3, 3), (5, 3)])
def test_range_must_not_be_empty(low: int, high: int) -> None:
    with pytest.raises(InputError, match="the minimum"):
        colour(np.zeros((1, 1)), np.ones((1, 1), bool), high, minimum=low)


def test_no_result_has_a_colour_of_its_own() -> None:
    ramp = np.linspace(0, 64, 300)[np.newaxis]
    valid = np.ones(ramp.shape, bool)
    assert not (colour(ramp, valid, 64) == NO_RESULT).all(2).any()
    valid[0, 7] = False
    ramp[0, 9] = np.nan
    assert np.argwhere((colour(ramp, valid, 64) == NO_RESULT).all(2)).tolist() == [[0, 7], [0, 9]]


def test_beyond_the_maximum_is_clipped() -> None:
    at, beyond = colour(np.array([[64, 900]]), np.ones((1, 2), bool), 64)[0]
    np.testing.assert_array_equal(at, beyond)


@pytest.mark.parametrize("maximum", [0, -1, np.nan])
def test_maximum_must_be_positive(maximum: float) -> None:
    with pytest.raises(InputError, match="maximum disparity"):
        colour(np.zeros((1, 1)), np.ones((1, 1), bool), maximum)


def test_error_classes_are_those_of_the_legend() -> None:
    truth = from_disparity(np.array([[10, 11, 11.25, 12, 12.25, 10, np.nan, np.nan]]))
    disparity = np.full((1, 8), 10, np.uint16)
    valid = np.array([[True] * 5 + [False, True, False]])
    classes = "within 1 px|within 1 px|1 to 2 px|1 to 2 px|over 2 px|no result|truth unknown|truth unknown"
    expected = [ERROR_COLOURS[name] for name in classes.split("|")]
    np.testing.assert_array_equal(error_picture(disparity, truth, valid)[0], expected)
    assert len(set(ERROR_COLOURS.values())) == len(ERROR_COLOURS)
    floats = np.where(valid, 10.0, np.nan)
    np.testing.assert_array_equal(error_picture(floats, truth)[0], expected)


def test_shapes_must_agree() -> None:
    with pytest.raises(InputError, match="the truth"):
        error_picture(np.zeros((2, 2)), from_disparity(np.ones((2, 3))))
    with pytest.raises(InputError, match="valid mask"):
        error_picture(np.zeros((2, 2)), from_disparity(np.ones((2, 2))), np.ones((1, 2), bool))
    with pytest.raises(InputError, match="valid mask"):
        colour(np.zeros((2, 2)), np.ones((1, 2), bool), 9)


def test_negative_disparities_have_colours_of_their_own():
    """Of a core whose range begins below 0: each has its own colour, and none looks like no result."""
    disparity = np.linspace(-8, 7, 16).reshape(2, 8)
    valid = np.ones(disparity.shape, bool)
    low, high = colour_range(disparity, valid)
    assert (low, high) == (-8, 7)
    picture = colour(disparity, valid, high, minimum=low).reshape(-1, 3)
    assert len(np.unique(picture, axis=0)) == 16
    shifted = colour(disparity + 8, valid, high + 8).reshape(-1, 3)
    assert np.array_equal(picture, shifted)
    assert not (picture == NO_RESULT).all(axis=1).any()
