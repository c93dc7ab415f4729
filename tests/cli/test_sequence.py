"""``softdepth sequence``: frames as the models give them, kept after a kill, and wrong inputs in a line."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from softdepth.golden import fixed_model
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.truth import read_truth
from softdepth.golden.data.writers import write_pfm, write_picture
from softdepth.golden.score.metrics import evaluate
from softdepth.sequence import video
from softdepth.spec.config import Config
from tests.rig import rigs

NAMES = ("f8", "f9", "f10")
"""In the order that people number them."""
SMALL = ("--preset", "sad", "--disparities", 8, "--lanes", 8, "--processes", 1)
CONFIG = Config.preset("sad").override(["disparities=8", "lanes=8", "max_width=48", "max_height=30"])
METRES = ("--focal", 100, "--baseline", 0.1)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> Path:
    """Three frames in ``left`` and ``right``, and their truth."""
    folder = tmp_path_factory.mktemp("recorded")
    for name in ("left", "right", "truth"):
        (folder / name).mkdir()
    for seed, name in enumerate(NAMES):
        pair = generate("random", width=48, height=30, disparities=8, seed=seed)
        assert pair.truth is not None
        write_picture(folder / "left" / f"{name}.png", pair.left)
        write_picture(folder / "right" / f"{name}.png", pair.right)
        write_pfm(folder / "truth" / f"{name}.pfm", pair.truth.disparity)
    return folder


@pytest.fixture
def scene(recorded, tmp_path) -> Path:
    """A copy to spoil."""
    shutil.copytree(recorded, tmp_path / "in")
    return tmp_path / "in"


def expected(folder: Path, name: str):
    pair = read_pair(folder / "left" / f"{name}.png", folder / "right" / f"{name}.png")
    return fixed_model.disparity(pair.left, pair.right, CONFIG)


def test_every_frame_is_the_models_and_stands_in_the_table(softdepth, scene, tmp_path):
    out = tmp_path / "out"
    outcome = softdepth(
        *("sequence", scene / "left", scene / "right", "--gt", scene / "truth", *SMALL, *METRES),
        *("--disparity-error", 0.25, "-o", out),
    )
    assert outcome.code == 0, outcome.err
    rows = list(csv.DictReader((out / "frames.csv").open()))
    assert [row["name"] for row in rows] == list(NAMES)
    for row in rows:
        found, place = expected(scene, row["name"]), out / "frames" / row["name"]
        written = read_truth(place / "disparity.pfm").disparity
        assert np.array_equal(np.nan_to_num(written), found.pixels * found.given)
        assert np.array_equal(np.array(Image.open(place / "code.png")), found.code)
        scores = evaluate(found.pixels, read_truth(scene / "truth" / f"{row['name']}.pfm"), valid=found.given)
        assert float(row["bad1"]) == pytest.approx(scores.as_dict()["bad1"], abs=1e-3)
        assert float(row["full_percent"]) == pytest.approx(100 * (found.code == 0).mean(), abs=1e-3)
        assert float(row["pixels_per_second"]) > 0
        depth, spread = (
            cv2.imread(str(place / name), cv2.IMREAD_UNCHANGED) for name in ("depth.tiff", "uncertainty.tiff")
        )
        assert depth is not None
        np.testing.assert_allclose(spread, depth**2 / 10 * 0.25, rtol=1e-5)
        report = json.loads((place / "frame.json").read_text())
        assert set(report["files"]) | {"frame.json"} == {each.name for each in place.iterdir()}
    assert (out / "frames.md").read_text().count("\n") == 2 + len(NAMES) + 1
    summary = json.loads((out / "sequence.json").read_text())
    assert (summary["frames"], summary["computed"], summary["config_hash"]) == (3, 3, CONFIG.hash)
    shown = list(video.Video.opened(out / "preview.webm").read())
    assert [frame.shape for frame in shown] == [(30, 96, 3)] * 3
    left = read_pair(scene / "left" / "f8.png", scene / "left" / "f9.png").left
    assert abs(shown[0][:, :48].astype(float).mean() - left.mean()) < 8


def test_what_is_there_is_kept_and_what_has_changed_is_not(softdepth, scene, tmp_path):
    out = tmp_path / "out"
    command = ("sequence", scene / "left", scene / "right", *SMALL, "-o", out)
    assert softdepth(*command).code == 0
    times = {name: (out / "frames" / name).stat().st_mtime_ns for name in NAMES}

    def again(*more: object) -> set[str]:
        """The frames that another run computes."""
        nonlocal times
        assert softdepth(*command, *more).code == 0
        now = {name: (out / "frames" / name).stat().st_mtime_ns for name in NAMES}
        changed = {name for name in NAMES if now[name] != times[name]}
        times = now
        assert json.loads((out / "sequence.json").read_text())["computed"] == len(changed)
        return changed

    assert again() == set()
    shutil.copy(scene / "left" / "f8.png", scene / "left" / "f9.png")
    assert again() == {"f9"}
    (out / "frames" / "f8" / "code.png").unlink()
    assert again() == {"f8"}
    (out / "frames" / "f10" / "frame.json").write_text("{")
    assert again() == {"f10"}
    assert again("--set", "criteria.0.window=5") == set(NAMES)
    assert again("--set", "criteria.0.window=5", *METRES) == set(NAMES)
    assert again("--set", "criteria.0.window=5", *METRES, "--measured-only") == set(NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, pytest.param(signal.SIGKILL, marks=pytest.mark.full)])
def test_a_killed_run_leaves_whole_frames_and_goes_on(softdepth, tmp_path, number):
    for name in ("left", "right"):
        (tmp_path / name).mkdir()
    pair = generate("random", width=320, height=240, disparities=16, seed=1)
    for k in range(8):
        write_picture(tmp_path / "left" / f"{k}.png", np.roll(pair.left, k, axis=0))
        write_picture(tmp_path / "right" / f"{k}.png", np.roll(pair.right, k, axis=0))
    frames = tmp_path / "out" / "frames"
    options = ("--preset", "sad", "--disparities", 32, "--processes", 2, "-o", tmp_path / "out")
    command = ["sequence", tmp_path / "left", tmp_path / "right", *options]
    program = [sys.executable, "-m", "softdepth", *map(str, command)]
    process = subprocess.Popen(program, stderr=subprocess.PIPE, start_new_session=True)
    deadline = time.monotonic() + 60
    while len(list(frames.glob("*/frame.json"))) < 2 and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(number)
    assert process.wait(30) == (-9 if number == signal.SIGKILL else 143)
    _wait_for_the_end_of(process.pid)
    assert not (tmp_path / "out" / "sequence.json").exists()
    done = [each.name for each in frames.iterdir() if not each.name.startswith(".")]
    assert 2 <= len(done) < 8
    for name in done:
        report = json.loads((frames / name / "frame.json").read_text())
        assert {*report["files"], "frame.json"} == {each.name for each in (frames / name).iterdir()}
    outcome = softdepth(*command)
    assert outcome.code == 0, outcome.err
    assert json.loads((tmp_path / "out" / "sequence.json").read_text())["computed"] == 8 - len(done)
    assert {each.name for each in frames.iterdir()} == {str(k) for k in range(8)}


def _wait_for_the_end_of(group: int) -> None:
    """Workers end with the process that has begun them."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    pytest.fail("a worker outlives the command")


@pytest.mark.slow
def test_the_simulated_gateware_runs_in_one_session_and_goes_on(softdepth, scene, tmp_path):
    out = tmp_path / "out"
    command = ("sequence", scene / "left", scene / "right", *SMALL, "--engine", "rtl", "-o", out)
    outcome = softdepth(*command)
    assert outcome.code == 0, outcome.err
    assert "gateware against fixed model: 0 mismatches" in outcome.out
    for name in NAMES:
        written = read_truth(out / "frames" / name / "disparity.pfm").disparity
        assert np.array_equal(np.nan_to_num(written), expected(scene, name).pixels)
    shutil.rmtree(out / "frames" / "f10")
    before = (out / "frames" / "f9").stat().st_mtime_ns
    assert softdepth(*command).code == 0
    assert (out / "frames" / "f9").stat().st_mtime_ns == before
    assert json.loads((out / "sequence.json").read_text())["computed"] == 1


def test_videos_globs_and_both_views_in_one(softdepth, recorded, tmp_path):
    views = {
        side: [read_pair(recorded / side / f"{n}.png", recorded / side / f"{n}.png").left for n in NAMES]
        for side in ("left", "right")
    }
    for side, frames in views.items():
        video.write(tmp_path / f"{side}.webm", frames, 25)
    video.write(tmp_path / "both.webm", [np.hstack(pair) for pair in zip(*views.values(), strict=True)], 25)
    sources = {
        "two": (tmp_path / "left.webm", tmp_path / "right.webm"),
        "one": (tmp_path / "both.webm", "--side-by-side"),
        "pattern": (recorded / "left" / "*.png", recorded / "right" / "f?*.png"),
    }
    for name, source in sources.items():
        out = tmp_path / name
        outcome = softdepth("sequence", *source, *SMALL, "-o", out)
        assert outcome.code == 0, outcome.err
        rows = list(csv.DictReader((out / "frames.csv").open()))
        names = NAMES if name == "pattern" else ("000000", "000001", "000002")
        assert [row["name"] for row in rows] == list(names)
        rate = video.Video.opened(out / "preview.webm").rate
        assert rate == pytest.approx(10 if name == "pattern" else 25, rel=0.01)


def test_rigs_each_with_its_own_calibration_and_frame(softdepth, recorded, tmp_path):
    camera = "[{f} 0 20; 0 {f} 15; 0 0 1]"
    text = f"cam0={camera}\ncam1={camera}\ndoffs=0\nbaseline={{b}}\nwidth=48\nheight=30\n"
    for name, f, b in (("front", 100, 50), ("rear", 200, 80)):
        shutil.copytree(recorded, tmp_path / "robot" / name)
        (tmp_path / "robot" / name / "calib.txt").write_text(text.format(f=f, b=b))
    out = tmp_path / "out"
    outcome = softdepth("sequence", tmp_path / "robot", *SMALL, "-o", out)
    assert outcome.code == 0, outcome.err
    for name, scale in (("front", 5.0), ("rear", 16.0)):
        place = out / name / "frames" / "f9"
        disparity = read_truth(place / "disparity.pfm").disparity
        depth = cv2.imread(str(place / "depth.tiff"), cv2.IMREAD_UNCHANGED)
        assert depth is not None
        np.testing.assert_allclose((depth * disparity)[disparity > 0], scale, rtol=1e-5)
        assert f"{name}_left_camera_optical_frame".encode() in (place / "cloud.ply").read_bytes()
        assert "bad1" in (out / name / "frames.csv").read_text()
    (tmp_path / "robot" / "rear" / "right").rename(tmp_path / "robot" / "rear" / "wrong")
    shutil.rmtree(out)
    assert "has no right view" in softdepth("sequence", tmp_path / "robot", *SMALL, "-o", out).error
    assert not out.exists()


def test_raw_frames_are_rectified_as_a_pair_is(softdepth, tmp_path):
    robot = tmp_path / "robot"
    calibration = robot / "camchain.yaml"
    pair = generate("random", width=rigs.SIZE[0], height=rigs.SIZE[1], disparities=8, seed=1)
    for side in ("left", "right"):
        (robot / side).mkdir(parents=True)
        write_picture(robot / side / "0.png", getattr(pair, side))
    rigs.kalibr(calibration)
    views, single = (robot / "left", robot / "right"), (robot / "left" / "0.png", robot / "right" / "0.png")
    rectify = ("--rectify", calibration)
    ways = {
        "run": ("run", *single, *rectify, *SMALL[:-2], "--engine", "fixed"),
        "sequence": ("sequence", *views, *rectify, *SMALL),
        "rig": ("sequence", robot, "--raw", *SMALL),
    }
    for name, command in ways.items():
        outcome = softdepth(*command, "-o", tmp_path / name)
        assert outcome.code == 0, outcome.err
    for name in ("sequence", "rig"):
        for file in ("disparity.pfm", "depth.tiff", "cloud.ply"):
            found = tmp_path / name / "frames" / "0" / file
            assert found.read_bytes() == (tmp_path / "run" / file).read_bytes()
        expected = (tmp_path / "run" / "calibration.yml").read_bytes()
        assert (tmp_path / name / "calibration.yml").read_bytes() == expected
    assert "say --raw" in softdepth("sequence", robot, *SMALL, "-o", tmp_path / "none").error


def unequal(scene: Path) -> None:
    (scene / "right" / "f10.png").unlink()


def exchanged(scene: Path) -> None:
    (scene / "right" / "f8.png").unlink()
    (scene / "left" / "f10.png").unlink()


def cropped(scene: Path) -> None:
    for side in ("left", "right"):
        path = scene / side / "f10.png"
        write_picture(path, read_pair(path, path).left[:, :40])


def cut(scene: Path) -> None:
    path = scene / "right" / "f9.png"
    path.write_bytes(path.read_bytes()[:300])


def few_truths(scene: Path) -> None:
    (scene / "truth" / "f9.pfm").unlink()


def broken_truth(scene: Path) -> None:
    (scene / "truth" / "f10.pfm").write_bytes(b"Pf\n4 4\n-1\n")


def twice(scene: Path) -> None:
    for side in ("left", "right"):
        shutil.copy(scene / side / "f9.png", scene / side / "f9.PNG")


@pytest.mark.parametrize(
    ("spoil", "more", "message"),
    [
        (unequal, (), "has 3 frames,"),
        (exchanged, (), "frame 'f9.png' would be paired with"),
        (cropped, (), "frame 'f10' is 40x30, but 'f8' is 48x30"),
        (cut, (), "f9.png' "),
        (few_truths, ("--gt", "truth"), "2 truths in"),
        (broken_truth, ("--gt", "truth"), "f10.pfm"),
        (twice, (), "would give results of one name"),
        (None, ("--fps", 0), "--fps 0 is no rate"),
        (None, ("--gt-scale", 2), "--gt-scale 2 without --gt"),
        (None, ("--min-confidence", 3), "has no confidence"),
        (None, ("--disparity-error", 1), "the cameras are not known"),
        (None, ("--disparity-error", "nan", *METRES), "--disparity-error nan is no error"),
        (None, ("--raw",), "--raw without a folder of rigs"),
        (None, ("--side-by-side",), "takes one sequence with both views"),
        (None, ("--calibration", "nowhere.yml"), "nowhere.yml"),
        (None, ("--set", "max_width=40"), "max_width = 40"),
    ],
)
def test_wrong_inputs_are_told_before_anything_is_written(softdepth, scene, tmp_path, spoil, more, message):
    if spoil:
        spoil(scene)
    more = [scene / "truth" if each == "truth" else each for each in more]
    out = tmp_path / "out"
    outcome = softdepth("sequence", scene / "left", scene / "right", *SMALL, *more, "-o", out)
    assert outcome.code == 2
    assert message in outcome.error
    assert not out.exists()


def test_wrong_sources(softdepth, scene, tmp_path):
    (tmp_path / "no.mp4").write_bytes(b"no video at all" * 100)
    (tmp_path / "empty").mkdir()
    for name, count in (("short", 2), ("long", 3)):
        video.write(
            tmp_path / f"{name}.webm", [np.full((32, 48, 3), 90 + k, np.uint8) for k in range(count)], 5
        )
    out = tmp_path / "out"
    for arguments, message in {
        (tmp_path / "no.mp4", tmp_path / "no.mp4"): "is no video that OpenCV can open",
        (tmp_path / "*.bmp", tmp_path / "*.png"): "no file matches",
        (tmp_path / "empty", tmp_path / "empty"): "holds no images",
        (tmp_path / "empty",): "holds no rig",
        (tmp_path / "nothing",): "does not exist",
        (tmp_path / "*.png",): "is one view",
        (tmp_path / "short.webm", tmp_path / "long.webm"): "has 2 frames,",
        (tmp_path / "short.webm", scene / "left"): "is a video,",
        (scene / "left" / "f8.png", scene / "right"): "is one image",
        (tmp_path / "long.webm", "--side-by-side", "--top-bottom"): "contradict each other",
        (scene / "left", scene / "right", "--frame-id", "a b", *METRES): "is no name",
    }.items():
        outcome = softdepth("sequence", *arguments, *SMALL, "-o", out)
        assert message in outcome.error, arguments
        assert not out.exists()


def test_inputs_are_never_replaced(softdepth, scene):
    (scene.parent / "frames").mkdir()
    shutil.copytree(scene, scene.parent / "frames" / "in")
    inside = scene.parent / "frames" / "in"
    outcome = softdepth("sequence", inside / "left", inside / "right", *SMALL, "-o", scene.parent)
    assert "which is read" in outcome.error
    outcome = softdepth("sequence", scene / "left", scene / "right", *SMALL, "-o", scene.parent)
    assert "is no frame of softdepth's" in outcome.error
    assert softdepth("run", scene / "left", scene / "right", *SMALL[:-2]).error.endswith("sequence for more")
