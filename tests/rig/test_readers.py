"""Calibrations of five kinds become one model; what is missing is named."""

import cv2
import numpy as np
import pytest

from softdepth.rig.readers import any as readers
from softdepth.rig.rectify import Rectifier
from softdepth.spec.errors import InputError
from tests.rig import rigs

MOTORCYCLE = """cam0=[994.978 0 311.193; 0 994.978 254.877; 0 0 1]
cam1=[994.978 0 342.279; 0 994.978 254.877; 0 0 1]
doffs=31.086
baseline=193.001
width=741
height=500
ndisp=70
"""


def same(found, lens=slice(None)):
    wanted = rigs.rig()
    for one, other in ((found.left, wanted.left), (found.right, wanted.right)):
        np.testing.assert_allclose(one.matrix, other.matrix)
        np.testing.assert_allclose(one.distortion.ravel(), other.distortion[lens])
    np.testing.assert_allclose(found.rotation, wanted.rotation, atol=1e-9)
    np.testing.assert_allclose(found.translation, wanted.translation, atol=1e-9)


@pytest.mark.parametrize("suffix", [".yml", ".xml"])
@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_opencv(tmp_path, suffix, unit):
    found = readers.read([rigs.opencv(tmp_path / f"c{suffix}", unit)], unit)
    same(found)
    assert found.left.size == rigs.SIZE


@pytest.mark.parametrize("key", ["M1", "D1", "M2", "D2", "R", "T"])
def test_a_key_that_opencv_leaves_out_is_named(tmp_path, key):
    with pytest.raises(InputError, match=rf"has no key '{key}'"):
        readers.read([rigs.opencv(tmp_path / "c.yml", leave_out=key)])


@pytest.mark.parametrize("names", [("Q",), ("P1", "P2"), ("R1", "R2", "P1", "P2", "Q")])
def test_what_stereo_rectify_gives_is_enough(tmp_path, names):
    """Of cameras whose principal points differ once rectified, lengths in millimetres."""
    r1, r2, p1, p2, q, *_ = cv2.stereoRectify(
        *(rigs.LEFT, rigs.LEFT_LENS, rigs.RIGHT, rigs.RIGHT_LENS, rigs.SIZE),
        *(rigs.ROTATION, 1000 * rigs.TRANSLATION[:, None]),
        flags=0,
    )
    storage = cv2.FileStorage(str(tmp_path / "c.yml"), cv2.FILE_STORAGE_WRITE)
    for name, matrix in {"R1": r1, "R2": r2, "P1": p1, "P2": p2, "Q": q}.items():
        if name in names:
            storage.write(name, matrix)
    storage.release()
    found = readers.read([tmp_path / "c.yml"], 0.001)
    assert found.rectified
    geometry = found.rectification.geometry
    assert abs(geometry.doffs) > 1
    x, y, z, w = q @ (40, 30, 12, 1)
    depth = geometry.depth(np.array([[12.0]]), np.ones((1, 1), bool))[0, 0]
    np.testing.assert_allclose(depth, z / w / 1000, rtol=1e-6)
    expected = np.array([x / w, y / w]) / 1000
    at = (np.array([40, 30]) - (geometry.cx, geometry.cy)) / geometry.focal * depth
    np.testing.assert_allclose(at, expected, rtol=1e-6)


def test_a_q_of_no_cameras_is_told(tmp_path):
    storage = cv2.FileStorage(str(tmp_path / "c.yml"), cv2.FILE_STORAGE_WRITE)
    storage.write("Q", np.zeros((4, 4)))
    storage.release()
    with pytest.raises(InputError, match=r"'Q' in .* focal length of 0"):
        readers.read([tmp_path / "c.yml"])


def test_intrinsics_and_what_stereo_rectify_gives_are_enough(tmp_path):
    path = rigs.opencv(tmp_path / "c.yml", unit=0.001, leave_out="R")
    found = Rectifier.of(rigs.rig(), rigs.SIZE).rectification
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_APPEND)
    for number, turn, view in zip("12", found.rotations, found.projections, strict=True):
        storage.write(f"R{number}", turn)
        storage.write(f"P{number}", view * (1, 1, 1, 1000))
    storage.release()
    same(readers.read([path], 0.001))


def test_kalibr(tmp_path):
    same(readers.read([rigs.kalibr(tmp_path / "chain.yaml")]), slice(4))


@pytest.mark.parametrize("key", ["intrinsics", "distortion_coeffs", "resolution", "T_cn_cnm1"])
def test_a_key_that_kalibr_leaves_out_is_named(tmp_path, key):
    path = rigs.kalibr(tmp_path / "chain.yaml")
    path.write_text(path.read_text().replace(key, "other"))
    with pytest.raises(InputError, match=rf"has no key 'cam[01]\.{key}'"):
        readers.read([path])


@pytest.fixture
def infos(tmp_path):
    rig = rigs.rig()
    found = Rectifier.of(rig, rigs.SIZE).rectification
    return [
        rigs.camera_info(tmp_path / f"{side}.yaml", camera.matrix, camera.distortion, rotation, projection)
        for side, camera, rotation, projection in zip(
            ("left", "right"), (rig.left, rig.right), found.rotations, found.projections, strict=True
        )
    ]


def test_ros(infos):
    same(readers.read(infos))


@pytest.mark.parametrize(
    "key", ["image_width", "projection_matrix", "distortion_model", "rectification_matrix"]
)
def test_a_key_that_ros_leaves_out_is_named(infos, key):
    infos[1].write_text(infos[1].read_text().replace(key, "other"))
    with pytest.raises(InputError, match=rf"right.yaml' has no key '{key}"):
        readers.read(infos)


def test_one_camera_of_two_is_not_enough(infos):
    with pytest.raises(InputError, match="give the right camera's file as well"):
        readers.read(infos[:1])


def test_cameras_the_wrong_way_round_are_told(infos):
    with pytest.raises(InputError, match="exchange the two calibrations"):
        readers.read(infos[::-1])


def test_middlebury(tmp_path):
    path = tmp_path / "calib.txt"
    path.write_text(MOTORCYCLE)
    found = readers.read([path])
    geometry = found.rectification.geometry
    assert found.rectified
    assert geometry.focal == pytest.approx(994.978)
    assert geometry.baseline == pytest.approx(0.193001)
    assert geometry.doffs == pytest.approx(31.086)
    assert (geometry.cx, geometry.cy) == (311.193, 254.877)
    assert found.left.size == (741, 500)


@pytest.mark.parametrize("key", ["cam1", "baseline"])
def test_a_key_that_middlebury_leaves_out_is_named(tmp_path, key):
    path = tmp_path / "calib.txt"
    path.write_text(MOTORCYCLE.replace(key, "other"))
    with pytest.raises(InputError, match=f"has no key '{key}'"):
        readers.read([path])


@pytest.mark.parametrize(("first", "second"), [("P2", "P3"), ("P0", "P1"), ("P_rect_02", "P_rect_03")])
def test_kitti(tmp_path, first, second):
    path = tmp_path / "calib.txt"
    left = "718.856 0 607.193 45.38 0 718.856 185.216 -0.11 0 0 1 0.003"
    right = "718.856 0 607.193 -337.29 0 718.856 185.216 2.37 0 0 1 0.005"
    path.write_text(f"calib_time: 09-Jan-2012 13:57:47\n{first}: {left}\n{second}: {right}\n")
    geometry = readers.read([path]).rectification.geometry
    assert geometry.focal == 718.856
    assert geometry.baseline == pytest.approx((45.38 + 337.29) / 718.856)
    assert geometry.doffs == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("P2: 1 2 3\nP3: 1 2 3\n", "'P2' in .* is not 3 x 4 numbers"),
        ("P2: 1 2 x\nP3: 1 2 3\n", "give numbers there"),
        ("hello\n", "is not a calibration of a known form"),
        ("cam0: [1, 2\n", "is not YAML"),
        ("cam0=[0 0 1; 0 1 1; 0 0 1]\ncam1=[0 0 1; 0 1 1; 0 0 1]\nbaseline=1\n", "focal length"),
        ("%YAML:1.0\n---\nM1: !!opencv-matrix\n  rows: 3\n", "not an OpenCV calibration|no key"),
        ("%YAML:1.0\n---\nother: 1\n", "has no key 'M1', 'P1' or 'Q'"),
        ("\ufeffcam0=[1 0 1; 0 1 1; 0 0 1]\n", "has no key 'cam1'"),
        (
            "%YAML:1.0\n---\nQ: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: d\n  data: ["
            + "0., " * 15
            + "0.]\n",
            "'Q' in .* focal length of 0",
        ),
        ("cam0=[nan 0 1; 0 1 1; 0 0 1]\ncam1=[1 0 1; 0 1 1; 0 0 1]\nbaseline=1\n", "not finite"),
    ],
)
def test_a_broken_file_is_one_line(tmp_path, text, message):
    path = tmp_path / "calib"
    path.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        readers.read([path])
    assert "\n" not in str(caught.value)


def test_no_file_is_one_line(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        readers.read([tmp_path / "none.yml"])


def test_distortion_of_a_wrong_length_is_told(tmp_path):
    path = rigs.opencv(tmp_path / "c.yml", leave_out="D1")
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_APPEND)
    storage.write("D1", np.zeros(3))
    storage.release()
    with pytest.raises(InputError, match="3 coefficients of distortion"):
        readers.read([path])
