"""Depth in metres from the command line: run, view, ros."""

import cv2
import numpy as np
import pytest
from plyfile import PlyData

from softdepth.cli.metres import FILES
from tests.cli.conftest import Files
from tests.ros.conftest import Recording, frames, record  # noqa: F401

CAMERAS = ("--focal", 500, "--baseline", 0.1)
SMALL = ("--preset", "sad", "--disparities", 16, "--lanes", 4)


def test_run_writes_metres(softdepth, files: Files, tmp_path):
    outcome = softdepth(
        "run",
        files.left,
        files.right,
        *SMALL,
        *CAMERAS,
        "--doffs",
        2,
        "--engine",
        "fixed",
        "--disparity-error",
        0.5,
        "-o",
        tmp_path / "o",
    )
    assert outcome.code == 0, outcome.err
    assert {path.name for path in (tmp_path / "o").iterdir()} > set(FILES)
    disparity = cv2.imread(str(tmp_path / "o" / "disparity.pfm"), cv2.IMREAD_UNCHANGED)
    depth = cv2.imread(str(tmp_path / "o" / "depth.tiff"), cv2.IMREAD_UNCHANGED)
    known = np.isfinite(disparity)
    np.testing.assert_array_equal(np.isfinite(depth), known)
    np.testing.assert_allclose(depth[known], 50 / (disparity[known] + 2), rtol=1e-6)
    spread = cv2.imread(str(tmp_path / "o" / "uncertainty.tiff"), cv2.IMREAD_UNCHANGED)
    np.testing.assert_allclose(spread[known], depth[known] ** 2 / 50 * 0.5, rtol=1e-6)
    assert len(PlyData.read(tmp_path / "o" / "cloud.ply")["vertex"]) == known.sum()


def test_a_later_run_without_cameras_leaves_no_metres(softdepth, files: Files, tmp_path):
    arguments = ("run", files.left, files.right, *SMALL, "--engine", "fixed", "-o", tmp_path / "o")
    assert softdepth(*arguments, *CAMERAS).code == 0
    assert softdepth(*arguments).code == 0
    assert not {path.name for path in (tmp_path / "o").iterdir()} & set(FILES)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("--focal", 500),
            "depth in metres needs --baseline; give both --focal (pixels) and --baseline (metres)",
        ),
        (("--baseline", 0.1), "depth in metres needs --focal"),
        (("--focal", 0, "--baseline", 0.1), "focal is 0; give a number of pixels above 0"),
        ((*CAMERAS, "--min-confidence", 300), "min_confidence is 300; use 0 to 255"),
        ((*CAMERAS, "--min-confidence", 3), "min_confidence is 3, but preset sad has no confidence"),
        ((*CAMERAS, "--set", "reference=right"), "depth in metres is for the left view"),
        (("--measured-only",), "--measured-only is about depth in metres"),
        (("--disparity-error", 0.5), "--disparity-error 0.5 is about depth in metres"),
        ((*CAMERAS, "--disparity-error", -1), "--disparity-error -1 is not an error"),
    ],
)
def test_what_is_missing_is_named(softdepth, files: Files, tmp_path, arguments, message):
    outcome = softdepth(
        "run", files.left, files.right, *SMALL, *arguments, "--engine", "fixed", "-o", tmp_path / "o"
    )
    assert outcome.code == 2
    assert message in outcome.error
    assert not (tmp_path / "o").exists()


def test_view_writes_a_page(softdepth, files: Files, tmp_path):
    page = tmp_path / "page.html"
    assert softdepth("view", files.left, files.right, *SMALL, *CAMERAS, "-o", page).code == 0
    assert "points in left_camera_optical_frame" in page.read_text()
    assert "depth in metres needs" in softdepth("view", files.left, files.right, *SMALL, "-o", page).error


def test_a_page_has_no_errors(softdepth, files: Files, tmp_path):
    arguments = ("view", files.left, files.right, *SMALL, *CAMERAS, "--disparity-error", 1)
    assert "give it to softdepth run" in softdepth(*arguments, "-o", tmp_path / "page.html").error
    assert not (tmp_path / "page.html").exists()


def test_ros(softdepth, frames, tmp_path):  # noqa: F811
    bag = record(tmp_path / "bag", Recording(frames(2, seed=1), frames(2, seed=2)))
    outcome = softdepth("ros", bag, *SMALL, "-o", tmp_path / "depth")
    assert (outcome.code, outcome.out) == (0, f"/stereo: 2 pairs\nbag: {tmp_path / 'depth'}\n"), outcome.err
    assert "exists already" in softdepth("ros", bag, *SMALL, "-o", tmp_path / "depth").error


@pytest.mark.parametrize("rig", ["/left", "left,right", "/a,/b,/c,/d"])
def test_a_rig_that_is_none(softdepth, tmp_path, frames, rig):  # noqa: F811
    bag = record(tmp_path / "bag", Recording(frames(1), frames(1)))
    assert "is not LEFT,RIGHT" in softdepth("ros", bag, "--rig", rig, "-o", tmp_path / "o").error


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (("--tolerance", -1), "--tolerance -1 is not a time"),
        (("--tolerance", "nan"), "--tolerance nan is not a time"),
        (("--set", "reference=right"), "depth in metres is for the left view"),
        (("--min-confidence", 9), "preset sad has no confidence"),
        (("--rig", "/left/image_rect,/nothing"), "the bag has no topic '/nothing'"),
        (("--rig", "/left/image_rect,/left/image_rect"), "has one topic for both views"),
        (("--set", "max_width=8"), "the core is built for max_width = 8"),
        (("--set", "criteria.0.window=15"), "the smallest frame is"),
    ],
)
def test_what_a_bag_cannot_give(softdepth, tmp_path, frames, more, message):  # noqa: F811
    bag = record(tmp_path / "bag", Recording(frames(1), frames(1)))
    assert message in softdepth("ros", bag, *SMALL, *more, "-o", tmp_path / "o").error
    assert {path.name for path in tmp_path.iterdir()} == {"bag"}


def test_no_bag(softdepth, tmp_path):
    assert "does not exist" in softdepth("ros", tmp_path / "none", "-o", tmp_path / "o").error
