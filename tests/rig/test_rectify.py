"""Rectified points lie on equal rows and have their true depth; pictures come back as they were."""

import cv2
import numpy as np
import pytest

from softdepth.golden.data.synthetic import generate
from softdepth.inspect.measurements import measure
from softdepth.rig import output
from softdepth.rig.camera import Camera
from softdepth.rig.readers import any as readers
from softdepth.rig.rectify import Rectifier
from softdepth.rig.rig import Rig
from softdepth.spec.errors import InputError
from tests.rig import rigs


@pytest.fixture(scope="module")
def rectifier() -> Rectifier:
    return Rectifier.of(rigs.rig(), rigs.SIZE)


def test_points_in_space_get_equal_rows_and_their_depth(rectifier):
    rng = np.random.default_rng(4)
    points = rng.uniform((-0.8, -0.6, 2), (0.8, 0.6, 6), (200, 3))
    rig, found = rigs.rig(), rectifier.rectification
    turn = cv2.Rodrigues(rig.rotation)[0]
    pixels = []
    for n, (camera, r, t) in enumerate(
        ((rig.left, np.zeros(3), np.zeros(3)), (rig.right, turn, rig.translation))
    ):
        raw, _ = cv2.projectPoints(points, r, t, camera.matrix, camera.distortion)
        rectified = cv2.undistortPoints(
            raw, camera.matrix, camera.distortion, R=found.rotations[n], P=found.projections[n]
        )
        pixels.append(rectified[:, 0])
    left, right = pixels
    np.testing.assert_allclose(left[:, 1], right[:, 1], atol=0.01)
    depth = rectifier.geometry.depth(left[:, 0] - right[:, 0], np.ones(len(left), bool))
    true = (found.rotations[0] @ points.T)[2]
    np.testing.assert_allclose(depth, true, rtol=1e-3)
    np.testing.assert_allclose(rectifier.geometry.baseline, rig.baseline)


def raw_pair(rectifier: Rectifier):
    rig, found = rigs.rig(), rectifier.rectification
    pair = generate("random", width=rigs.SIZE[0], height=rigs.SIZE[1], disparities=24, seed=2)
    views = [
        rigs.seen_raw(view, camera, rotation, projection)
        for view, camera, rotation, projection in zip(
            (pair.left, pair.right), (rig.left, rig.right), found.rotations, found.projections, strict=True
        )
    ]
    return pair, views


def test_pictures_come_back_and_their_rows_agree(rectifier):
    pair, raw = raw_pair(rectifier)
    before, (left, right) = measure(*raw), rectifier.apply(*raw)
    after = measure(left, right)
    assert before.rows is not None
    assert after.rows is not None
    assert max(abs(before.rows.offset), before.rows.change) > 1.5
    assert abs(after.rows.offset) + after.rows.change < 0.15
    middle = np.s_[40:-40, 40:-40]
    off = np.abs(left[middle].astype(int) - pair.left[middle].astype(int)).mean()
    assert off < 0.6 * np.abs(raw[0][middle].astype(int) - pair.left[middle].astype(int)).mean()


def test_the_row_budget_is_what_plain_loops_count(rectifier):
    for field, budget in zip(rectifier.maps, rectifier.row_budget(), strict=True):
        up = down = 0.0
        for y in range(rigs.SIZE[1]):
            for x in range(rigs.SIZE[0]):
                column, row = field[y, x]
                if -1 < column < rigs.SIZE[0] and -1 < row < rigs.SIZE[1]:
                    up, down = max(up, y - row), max(down, row - y)
        assert budget == (int(np.ceil(up)), int(np.ceil(down)))
        assert sum(budget) > 2


def test_the_written_calibration_is_read_as_the_same_geometry(rectifier, tmp_path):
    path = tmp_path / "calibration.yml"
    path.write_text(output.calibration(rectifier, *rigs.SIZE))
    found = readers.read([path])
    assert found.rectified
    assert found.left.size == rigs.SIZE
    for name in ("focal", "baseline", "doffs", "cx", "cy"):
        wanted = getattr(rectifier.geometry, name)
        assert getattr(found.rectification.geometry, name) == pytest.approx(wanted, abs=1e-9)
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    q = storage.getNode("Q").mat()
    x = q @ np.array([200.0, 100.0, 20.0, 1.0])
    assert x[2] / x[3] == pytest.approx(rectifier.geometry.distance(20.0))


def test_a_fisheye_rig_is_rectified_too():
    lens = np.array([0.02, -0.003, 0.001, -0.0002])
    left, right = (Camera(m, lens, "equidistant", rigs.SIZE) for m in (rigs.LEFT, rigs.RIGHT))
    found = Rectifier.of(Rig(left, right, rigs.ROTATION, rigs.TRANSLATION), rigs.SIZE)
    assert found.geometry.baseline == pytest.approx(np.linalg.norm(rigs.TRANSLATION))
    assert np.isfinite(found.maps[0]).all()


def test_images_of_another_size_are_refused():
    with pytest.raises(InputError, match="the images are 640x480, the left camera is calibrated for 320x240"):
        Rectifier.of(rigs.rig(), (640, 480))


def test_cameras_above_each_other_are_refused():
    rig = rigs.rig()
    with pytest.raises(InputError, match="above each other"):
        Rectifier.of(Rig(rig.left, rig.right, np.eye(3), np.array([0.0, -0.1, 0.0])), rigs.SIZE)


def test_cameras_in_one_place_are_refused():
    rig = rigs.rig()
    with pytest.raises(InputError, match="in the same place"):
        Rectifier.of(Rig(rig.left, rig.right, np.eye(3), np.zeros(3)), rigs.SIZE)
