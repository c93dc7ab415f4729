"""How far two maps are from each other, against figures worked out by hand."""

import numpy as np
import pytest

from softdepth.golden.data.truth import from_disparity
from softdepth.golden.maps import DisparityMap
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity
from softdepth.studies.compare.agreement import agreement


def depth(rows: list[list[int]], border: tuple[int, int] | None = None) -> DisparityMap:
    disparity = np.array(rows, np.uint16)
    code = np.zeros(disparity.shape, np.uint8)
    if border:
        code[border] = Validity.BORDER
    return DisparityMap(disparity, code)


FIRST = depth([[5, 5, 5, 5], [9, 9, 0, 9]])
SECOND = depth([[5, 6, 7, 2], [9, 9, 9, 9]])


def test_shares_and_distances():
    found = agreement(FIRST, SECOND)
    assert found.pixels == 8
    assert (found.differ, found.differ1, found.differ2) == (50, 37.5, 25)
    assert found.mae == (1 + 2 + 3 + 9) / 8
    assert found.rmse == pytest.approx(((1 + 4 + 9 + 81) / 8) ** 0.5)
    assert (found.closer, found.farther) == (None, None)


def test_pixels_without_a_result_do_not_count():
    found = agreement(FIRST, depth(SECOND.disparity.tolist(), border=(1, 2)))
    assert (found.pixels, found.mae) == (7, 6 / 7)


def test_which_map_is_nearer_to_the_truth():
    # Of the four that differ: first nearer, neither (5 and 7 around 6), second nearer, unknown.
    truth = from_disparity(np.array([[5, 5, 6, 2.4], [0, 0, np.nan, 0]]))
    found = agreement(FIRST, SECOND, truth)
    assert found.closer == pytest.approx(100 / 3)
    assert found.farther == pytest.approx(100 / 3)
    swapped = agreement(SECOND, FIRST, from_disparity(np.array([[5, 5, 5, 5], [0, 0, 0, 0.0]])))
    assert (swapped.closer, swapped.farther) == (0, 100)


def test_equal_maps_leave_nobody_nearer():
    found = agreement(FIRST, FIRST, from_disparity(np.ones((2, 4))))
    assert (found.differ, found.rmse, found.closer) == (0, 0, None)


def test_maps_that_cannot_be_compared():
    with pytest.raises(InputError, match=r"\(2, 4\) and \(1, 4\)"):
        agreement(FIRST, depth([[1, 2, 3, 4]]))
    with pytest.raises(InputError, match="no pixel"):
        agreement(depth([[1]]), depth([[1]], border=(0, 0)))
