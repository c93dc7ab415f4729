"""Calibration files on the command line: metres, ranges, and raw pairs that are rectified first."""

import cv2
import numpy as np
import pytest
from plyfile import PlyData

from softdepth.golden.data.writers import write_picture
from softdepth.rig.readers import any as readers
from softdepth.rig.rectify import Rectifier
from tests.cli.conftest import Files
from tests.rig import rigs
from tests.rig.test_rectify import raw_pair

CALIB = "cam0=[500 0 20; 0 500 14; 0 0 1]\ncam1=[500 0 22; 0 500 14; 0 0 1]\ndoffs=2\nbaseline=100\n"
SIZE = "width=48\nheight=30\n"
SMALL = ("--preset", "sad", "--disparities", 16, "--lanes", 4, "--engine", "fixed")
RAW = ("--preset", "sad", "--disparities", 32, "--engine", "fixed", "--rectify", "rig.yml", "--unit", 0.001)


@pytest.fixture
def calib(tmp_path):
    path = tmp_path / "calib.txt"
    path.write_text(CALIB + SIZE)
    return path


def test_a_file_is_as_good_as_its_numbers(softdepth, files: Files, calib, tmp_path):
    numbers = ("--focal", 500, "--baseline", 0.1, "--doffs", 2, "--principal", 20, 14)
    images = ("run", files.left, files.right, *SMALL)
    outcome = softdepth(*images, "--calibration", calib, "--frame-id", "front_left", "-o", tmp_path / "file")
    assert outcome.code == 0, outcome.err
    assert softdepth(*images, *numbers, "-o", tmp_path / "numbers").code == 0
    file, other = (PlyData.read(tmp_path / name / "cloud.ply") for name in ("file", "numbers"))
    assert len(file["vertex"]) > 500
    np.testing.assert_array_equal(file["vertex"].data, other["vertex"].data)
    assert "optical frame front_left:" in file.comments[0]
    assert not (tmp_path / "file" / "calibration.yml").exists()


def test_two_files_make_a_page(softdepth, tmp_path):
    rig = rigs.rig()
    found = Rectifier.of(rig, rigs.SIZE)
    infos = [
        rigs.camera_info(tmp_path / f"{side}.yaml", camera.matrix, camera.distortion, turn, view)
        for side, camera, turn, view in zip(
            ("left", "right"),
            (rig.left, rig.right),
            found.rectification.rotations,
            found.rectification.projections,
            strict=True,
        )
    ]
    for name in ("l.png", "r.png"):
        write_picture(tmp_path / name, np.zeros((*rigs.SIZE[::-1], 3), np.uint8))
    files = [part for path in infos for part in ("--calibration", path)]
    page = tmp_path / "page.html"
    images = (tmp_path / "l.png", tmp_path / "r.png")
    outcome = softdepth("view", *images, "--preset", "sad", *files, "--frame-id", "arm", "-o", page)
    assert outcome.code == 0, outcome.err
    assert "points in arm" in page.read_text()
    assert (
        f"focal length {found.geometry.focal:g} px, baseline {found.geometry.baseline:g} m"
        in page.read_text()
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("--calibration", "calib.txt", "--focal", 500),
            "--calibration calib.txt and --focal contradict each other; give the calibration or the numbers",
        ),
        (("--calibration", "calib.txt", "--doffs", 0), "--calibration calib.txt and --doffs contradict"),
        (("--rectify", "rig.yml", "--principal", 1, 1), "--rectify rig.yml and --principal contradict"),
        (("--rectify", "rig.yml", "--calibration", "calib.txt"), "--calibration calib.txt contradict"),
        (("--calibration", "large.txt"), "the images are 48x30, 'large.txt' is for 96x60"),
        (("--rectify", "rig.yml"), "the images are 48x30, the left camera is calibrated for 320x240"),
        (("--calibration", "rig.yml"), "'rig.yml' does not tell how its images were rectified"),
        (("--rectify", "calib.txt"), "'calib.txt' is the calibration of rectified images"),
        (("--calibration", "none.txt"), "'none.txt' cannot be read"),
        (("--calibration", "calib.txt", "--unit", 0), "--unit 0 is not a length"),
        (("--unit", 0.001, "--focal", 5, "--baseline", 1), "--unit 0.001 without a calibration"),
        (("--doffs", 3), "depth in metres needs --focal"),
        (("--calibration", "calib.txt", "--frame-id", "a b"), "--frame-id 'a b' is not a name"),
    ],
)
@pytest.mark.parametrize("command", ["run", "view"])
def test_a_wrong_call_is_one_line(
    softdepth, files: Files, calib, tmp_path, monkeypatch, command, arguments, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "large.txt").write_text(CALIB + "width=96\nheight=60\n")
    rigs.opencv(tmp_path / "rig.yml", 0.001)
    chosen = SMALL if command == "run" else SMALL[:-2]
    outcome = softdepth(command, files.left, files.right, *chosen, *arguments, "-o", tmp_path / "o")
    assert outcome.code == 2
    assert message in outcome.error
    assert not (tmp_path / "o").exists()


@pytest.fixture
def raw(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene, views = raw_pair(Rectifier.of(rigs.rig(), rigs.SIZE))
    for name, view in zip(("left.png", "right.png"), views, strict=True):
        write_picture(tmp_path / name, view)
    rigs.opencv(tmp_path / "rig.yml", 0.001)
    return scene


def test_a_raw_pair_is_rectified_before_it_runs(softdepth, raw, tmp_path):
    outcome = softdepth("run", "left.png", "right.png", *RAW, "-o", "o")
    assert outcome.code == 0, outcome.err
    geometry = Rectifier.of(rigs.rig(), rigs.SIZE).geometry
    written = readers.read([tmp_path / "o" / "calibration.yml"])
    assert written.rectified
    assert written.rectification.geometry.focal == pytest.approx(geometry.focal)
    assert written.rectification.geometry.baseline == pytest.approx(0.12, rel=1e-3)
    depth = cv2.imread("o/depth.tiff", cv2.IMREAD_UNCHANGED)
    truth = geometry.depth(raw.truth.disparity, raw.truth.nonoccluded)
    inside = np.s_[40:-40, 60:-40]
    seen = raw.truth.nonoccluded[inside]
    near = np.abs(depth[inside] / truth[inside] - 1)[seen] < 0.1
    assert near.mean() > 0.8
    page = softdepth("view", "left.png", "right.png", *RAW[:4], *RAW[6:], "-o", "page.html")
    assert page.code == 0, page.err


def test_a_later_run_leaves_no_calibration_of_another_pair(softdepth, raw, tmp_path):
    arguments = ("run", "left.png", "right.png", *RAW)
    assert softdepth(*arguments, "-o", "o").code == 0
    kept = (*arguments[:-4], "--calibration", "o/calibration.yml")
    assert softdepth(*kept, "-o", "o").code == 0  # it is read: it stays
    assert (tmp_path / "o" / "calibration.yml").exists()
    assert softdepth(*arguments[:-4], "-o", "o").code == 0
    assert not (tmp_path / "o" / "calibration.yml").exists()
    rigs.opencv(tmp_path / "o" / "calibration.yml")  # the user's own
    assert softdepth(*arguments[:-4], "-o", "o").code == 0
    assert readers.read([tmp_path / "o" / "calibration.yml"]).translation[0] == -0.12


def test_no_result_replaces_what_is_read(softdepth, raw, tmp_path):
    (tmp_path / "rig.yml").rename(tmp_path / "calibration.yml")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    arguments = ("left.png", "right.png", *RAW[:6], "--rectify", "calibration.yml", "-o", tmp_path)
    assert "would replace 'calibration.yml', which is read" in softdepth("run", *arguments).error
    for images in (("left.png", "right.png"), ("right.png", "left.png")):
        outcome = softdepth("rectify", *images, "--calibration", "calibration.yml", "-o", tmp_path)
        assert "would replace 'left.png', which is read" in outcome.error
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_data_set_is_no_raw_pair(softdepth, tmp_path):
    outcome = softdepth("run", "--dataset", "motorcycle", "--rectify", "rig.yml", "-o", tmp_path / "o")
    assert "--dataset motorcycle is rectified already" in outcome.error


def test_info_tells_the_range_in_metres(softdepth, calib, tmp_path):
    out = softdepth("info", "--preset", "sad", "--disparities", 16, "--lanes", 4, "--calibration", calib).out
    assert "2.941 m (15 px) to 25.000 m (0 px)" in out
    assert "1 m: none, 2 m: none, 5 m: 500.0 mm" in out
    by_numbers = softdepth("info", "--preset", "robust", "--focal", 500, "--baseline", 0.1).out
    assert "0.794 m (63 px) to 100.000 m (0.5 px)" in by_numbers
    assert "1 m: 1.2 mm, 2 m: 5.0 mm, 5 m: 31.2 mm, 10 m: 125.0 mm" in by_numbers
    rigs.opencv(tmp_path / "rig.yml")
    geometry = Rectifier.of(rigs.rig(), rigs.SIZE).geometry
    raw = softdepth("info", "--preset", "sad", "--calibration", tmp_path / "rig.yml").out
    assert f"{geometry.distance(63):.3f} m (63 px) to {geometry.distance(1):.3f} m (1 px)" in raw
    assert "depth" not in softdepth("info", "--preset", "sad").out.replace("softdepth", "")
    nothing = softdepth("info", "--preset", "sad", "--focal", 5, "--baseline", 1, "--doffs", -99).out
    assert "no candidate is above -doffs = 99 px" in nothing
