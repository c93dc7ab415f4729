"""Disparities to metres and back, by hand."""

import math

import numpy as np
import pytest

from softdepth.rig.geometry import Geometry
from softdepth.spec.errors import InputError

MOTORCYCLE = Geometry(994.978, 0.193001, 31.086, 311.193, 254.877)


def test_depth_is_focal_times_baseline_over_disparity():
    disparity = np.array([[0.0, 28.914, 60.0]])
    depth = MOTORCYCLE.depth(disparity, np.array([[True, True, False]]))
    np.testing.assert_allclose(depth, [[192.031749 / 31.086, 192.031749 / 60, np.nan]], rtol=1e-6)
    assert MOTORCYCLE.distance(28.914) == pytest.approx(192.031749 / 60)


def test_nothing_finite_lies_at_zero_or_behind():
    depth = Geometry(100, 0.1).depth(np.array([[0.0, -3.0, 2.0]]), np.ones((1, 3), bool))
    assert np.isnan(depth[0, :2]).all()
    assert depth[0, 2] == 5
    assert math.isinf(Geometry(100, 0.1).distance(0))


def test_points_project_back_onto_their_pixels():
    depth = np.full((3, 4), 2.0, np.float32)
    points = MOTORCYCLE.points(depth)
    for y, x in np.ndindex(3, 4):
        px, py, pz = points[y, x]
        assert MOTORCYCLE.focal * px / pz + MOTORCYCLE.cx == pytest.approx(x, abs=1e-3)
        assert MOTORCYCLE.focal * py / pz + MOTORCYCLE.cy == pytest.approx(y, abs=1e-3)
        assert pz == 2


def test_uncertainty_is_what_a_step_of_disparity_moves():
    geometry = Geometry(500, 0.12)
    here = geometry.distance(20)
    moved = (geometry.distance(19.99) - geometry.distance(20.01)) / 2
    assert geometry.uncertainty(np.float32([[here]]), 0.01)[0, 0] == pytest.approx(moved, rel=1e-3)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"focal": 0}, "focal is 0; give a number of pixels above 0"),
        ({"focal": math.nan}, "focal is nan"),
        ({"baseline": -0.1}, "baseline is -0.1; give a number of metres above 0"),
        ({"doffs": math.inf}, "doffs is inf"),
    ],
)
def test_what_cannot_be_is_refused(values, message):
    with pytest.raises(InputError) as caught:
        Geometry(**{"focal": 500, "baseline": 0.1, **values})
    assert message in str(caught.value)
