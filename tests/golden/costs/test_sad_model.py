"""The SAD criterion against OpenCV's box filter."""

import cv2
import numpy as np
import pytest

from softdepth.golden.costs.criteria import FrameCriteria
from softdepth.golden.costs.sad import absolute_difference, sad
from softdepth.spec.config import Config, PixelFormat, Sad


def planes(height, width, seed):
    return np.random.default_rng(seed).integers(0, 256, (3, height, width), dtype=np.uint8)


def opencv_sums(left, right, window):
    """SAD of the window centred at each pixel; right only where the window is inside."""
    difference = np.sum([cv2.absdiff(a, b) for a, b in zip(left, right, strict=True)], axis=0, dtype=float)
    return cv2.boxFilter(difference, cv2.CV_64F, (window, window), normalize=False)


def opencv_sad(left, right, window):
    sums = opencv_sums(left, right, window)
    r = window // 2
    return sums[r : sums.shape[0] - r, r : sums.shape[1] - r]


@pytest.mark.parametrize("window", range(1, 16, 2))
def test_sad_equals_opencv(window):
    left, right = planes(23, 31, 0), planes(23, 31, 1)
    criterion = Sad(window=window)
    got = sad(criterion, left, right)
    assert got.dtype == np.int32
    np.testing.assert_array_equal(got, opencv_sad(left, right, window))


@pytest.mark.parametrize("window", range(1, 16, 2))
def test_the_largest_sum_fits(window):
    black, white = np.zeros((3, 17, 17), np.uint8), np.full((3, 17, 17), 255, np.uint8)
    criterion = Sad(window=window)
    assert (sad(criterion, black, white) == window * window * 765).all()
    assert (sad(criterion, white, black) == criterion.maximum_of(PixelFormat.RGB8)).all()


def test_absolute_difference_sums_the_channels():
    left = np.array([[[255]], [[10]], [[0]]], np.uint8)
    right = np.array([[[0]], [[12]], [[255]]], np.uint8)
    assert absolute_difference(left, right).tolist() == [[512]]


def test_criteria_look_at_their_own_place():
    """Windows of several sizes and shifts, cut out of OpenCV's full-frame sums."""
    config = Config.from_dict(
        {"criteria": [{"window": 3, "dx": 4}, {"window": 7, "dx": -2}, {"window": 1, "dx": -8}]}
    )
    left, right = planes(20, 40, 2), planes(20, 40, 3)
    rows, columns = slice(3, 17), slice(8, 35)  # radius 3; from the shift -8 to 4 + radius 1
    criteria = FrameCriteria(config, left.transpose(1, 2, 0), right.transpose(1, 2, 0)).band(3, 17)(0)
    for criterion, values in zip(config.criteria, criteria, strict=True):
        sums = opencv_sums(left, right, criterion.window)
        expected = np.roll(sums, -criterion.dx, axis=1)[rows, columns]
        np.testing.assert_array_equal(values, expected)
