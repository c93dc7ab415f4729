"""The pictures of a comparison mean what their legends say."""

import cv2
import numpy as np
import pytest

from softdepth.golden import float_model
from softdepth.golden.maps import DisparityMap
from softdepth.spec.validity import Validity
from softdepth.studies.compare.pictures import DIFFERENCE_COLOURS, RING, mark_differences, sweep_plot
from softdepth.studies.compare.sweep import sweep


def decode(png: bytes) -> np.ndarray:
    picture = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    return picture[:, :, ::-1]


def test_marks_follow_the_size_of_the_difference():
    image = np.zeros((1, 5, 3), np.uint8)
    image[0, 0] = (255, 255, 255)
    code = np.array([[0, 0, 0, 0, Validity.BORDER]], np.uint8)
    first = DisparityMap(np.array([[7, 7, 7, 7, 0]], np.uint16), code)
    second = DisparityMap(np.array([[7, 8, 5, 60, 0]], np.uint16), code)
    for pair in ((first, second), (second, first)):
        found = mark_differences(image, *pair)[0].tolist()
        assert found[1:] == [list(rgb) for rgb in DIFFERENCE_COLOURS.values()]
        assert len(set(found[0])) == 1, "gray"
        assert found[0][0] < 255, "dimmed"


@pytest.fixture
def swept(config, pair, monkeypatch):
    monkeypatch.setattr("softdepth.studies.compare.sweep.MEMBERSHIP_BITS", range(4, 6))
    return sweep(pair, config, float_model.disparity(pair.left, pair.right, config))


def has_ring(picture: np.ndarray) -> bool:
    rgb = [int(RING[i : i + 2], 16) for i in (1, 3, 5)]
    return bool((np.abs(picture.astype(int) - rgb).max(axis=2) <= 3).any())


def test_the_plot_has_a_panel_for_the_truth_where_it_is_known(swept):
    with_truth = decode(sweep_plot(swept, "a pair", 20.0, (5, 12)))
    without = decode(sweep_plot(swept, "a pair", None, (5, 12)))
    assert with_truth.shape[1] == pytest.approx(1.5 * without.shape[1], abs=2)
    assert has_ring(with_truth)
    assert has_ring(without)


@pytest.mark.parametrize("format_", [(5, None), (12, 12)])
def test_a_format_that_was_not_swept_has_no_ring(swept, format_):
    assert not has_ring(decode(sweep_plot(swept, "a pair", 20.0, format_)))
