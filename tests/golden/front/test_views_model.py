"""Disparity maps, reference views, and what the models demand of a pair."""

import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.front.views import from_core_view, to_core_view
from softdepth.golden.maps import DisparityMap
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity


def make_map(disparity, code=None):
    disparity = np.array(disparity, np.uint16)
    return DisparityMap(disparity, np.zeros(disparity.shape, np.uint8) if code is None else code)


def image(height=9, width=12):
    return np.arange(height * width * 3).astype(np.uint8).reshape(height, width, 3)


def test_valid_is_everything_below_border():
    codes = np.array([[Validity.FULL, Validity.PARTIAL, Validity.BORDER, 3]], np.uint8)
    assert make_map([[1, 2, 0, 0]], codes).valid.tolist() == [[True, True, False, False]]


def test_differences_name_place_and_both_results():
    expected = make_map([[1, 2], [3, 4]])
    got = make_map([[1, 9], [3, 4]], np.array([[0, 0], [2, 7]], np.uint8))
    found = list(expected.differences(got))
    assert [str(d) for d in found] == [
        "y=0 x=1: expected 2 (FULL), got 9 (FULL)",
        "y=1 x=0: expected 3 (FULL), got 3 (BORDER)",
        "y=1 x=1: expected 4 (FULL), got 4 (code 7)",
    ]
    y, x, want, have = found[0]
    assert (y, x, want, have) == (0, 1, (2, 0, None), (9, 0, None))
    assert list(expected.differences(expected)) == []


def test_differences_of_other_shapes_are_refused():
    with pytest.raises(InputError, match=r"\(1, 2\).*\(2, 1\)"):
        make_map([[1, 2]]).differences(make_map([[1], [2]]))


@pytest.mark.parametrize(
    ("disparity", "code", "message"),
    [
        (np.zeros((2, 2), np.uint8), np.zeros((2, 2), np.uint8), "disparity is uint8"),
        (np.zeros((2, 2), np.uint16), np.zeros((2, 2), np.int64), "code is int64"),
        (np.zeros((2, 2, 1), np.uint16), np.zeros((2, 2), np.uint8), r"shape \(2, 2, 1\)"),
        (np.zeros((2, 2), np.uint16), np.zeros((2, 3), np.uint8), r"\(2, 2\).*\(2, 3\)"),
    ],
)
def test_malformed_maps_are_refused(disparity, code, message):
    with pytest.raises(InputError, match=message):
        DisparityMap(disparity, code)


def test_the_right_view_is_swapped_and_mirrored():
    left, right = image(), image()[::-1]
    config = Config.from_dict({"reference": "right"})
    a, b = to_core_view(left, right, config)
    assert (a == right[:, ::-1]).all()
    assert (b == left[:, ::-1]).all()
    result = make_map([[1, 2, 3]], np.array([[0, 1, 2]], np.uint8))
    back = from_core_view(result, config)
    assert back.disparity.tolist() == [[3, 2, 1]]
    assert back.code.tolist() == [[2, 1, 0]]


def test_the_left_view_is_the_cores():
    left, right = image(), image()[::-1]
    config = Config.from_dict({})
    assert to_core_view(left, right, config) == (left, right)
    result = make_map([[1, 2, 3]])
    assert from_core_view(result, config) is result


@pytest.mark.parametrize("model", [fixed_model.disparity, float_model.disparity])
@pytest.mark.parametrize(
    ("left", "right", "message"),
    [
        (image().astype(np.uint16), image(), "left image is uint16"),
        (image(), image().astype(np.float32), "right image is float32"),
        (image()[:, :, 0], image(), r"left image has shape \(9, 12\)"),
        (image(), np.zeros((9, 12, 4), np.uint8), r"right image has shape \(9, 12, 4\)"),
        (np.zeros((0, 12, 3), np.uint8), np.zeros((0, 12, 3), np.uint8), r"\(0, 12, 3\)"),
        (image(9, 12), image(9, 13), "12x9.*13x9"),
    ],
)
def test_unusable_pairs_are_refused(model, left, right, message):
    with pytest.raises(InputError, match=message):
        model(left, right, Config.from_dict({}))
