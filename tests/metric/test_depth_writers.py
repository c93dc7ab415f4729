"""Files of depth, read back by other libraries where there are any."""

import cv2
import numpy as np
import pytest
from plyfile import PlyData

from softdepth.metric import writers
from softdepth.metric.scene import Scene
from softdepth.rig.geometry import Geometry
from softdepth.spec.errors import InputError

DEPTH = np.array([[np.nan, 0.0004, 1.2344], [1.2346, 65.5349, 65.536]], np.float32)
SCENE = Scene(
    Geometry(100, 0.1, cx=1, cy=0.5),
    DEPTH,
    np.array([[False, True, False], [False, False, True]]),
    np.arange(18, dtype=np.uint8).reshape(2, 3, 3),
)


def test_millimetres(tmp_path):
    assert writers.write_depth_png(tmp_path / "depth.png", DEPTH) == 1
    found = cv2.imread(str(tmp_path / "depth.png"), cv2.IMREAD_UNCHANGED)
    assert found.dtype == np.uint16
    np.testing.assert_array_equal(found, [[0, 1, 1234], [1235, 65535, 0]])


def test_metres_in_tiff(tmp_path):
    writers.write_depth_tiff(tmp_path / "depth.tiff", DEPTH)
    found = cv2.imread(str(tmp_path / "depth.tiff"), cv2.IMREAD_UNCHANGED)
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, DEPTH)


def test_metres_in_pfm(tmp_path):
    writers.write_depth_pfm(tmp_path / "depth.pfm", DEPTH)
    found = cv2.imread(str(tmp_path / "depth.pfm"), cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(found, np.where(np.isnan(DEPTH), np.inf, DEPTH))


def test_ply(tmp_path):
    assert writers.write_ply(tmp_path / "cloud.ply", SCENE) == 5
    vertices = PlyData.read(tmp_path / "cloud.ply")["vertex"]
    points, colours, filled = SCENE.points()
    np.testing.assert_array_equal(np.stack([vertices[name] for name in "xyz"], 1), points)
    np.testing.assert_array_equal(np.stack([vertices[n] for n in ("red", "green", "blue")], 1), colours)
    np.testing.assert_array_equal(vertices["filled"], filled)


def test_ply_without_colour_or_points(tmp_path):
    empty = Scene(SCENE.geometry, np.full_like(DEPTH, np.nan), SCENE.filled)
    assert writers.write_ply(tmp_path / "cloud.ply", empty) == 0
    assert "red" not in PlyData.read(tmp_path / "cloud.ply")["vertex"].data.dtype.names


def test_npz(tmp_path):
    writers.write_npz(tmp_path / "cloud.npz", SCENE)
    with np.load(tmp_path / "cloud.npz") as found:
        points, colours, filled = SCENE.points()
        np.testing.assert_array_equal(found["points"], points)
        np.testing.assert_array_equal(found["colours"], colours)
        np.testing.assert_array_equal(found["filled"], filled)
        np.testing.assert_array_equal(found["depth"], DEPTH)
        assert found["focal"] == 100


def test_a_place_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        writers.write_ply(tmp_path / "none" / "cloud.ply", SCENE)
