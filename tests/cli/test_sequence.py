"""``softdepth sequence``: frames as the models give them, from files, videos and rigs."""

import csv
import json
import shutil

import cv2
import numpy as np
import pytest
from PIL import Image

from softdepth.golden.data.images import read_pair
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.truth import read_truth
from softdepth.golden.data.writers import write_picture
from softdepth.golden.score.metrics import evaluate
from softdepth.sequence import video
from tests.cli.recording import CONFIG, METRES, NAMES, SMALL, expected
from tests.rig import rigs


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
    assert "add --raw" in softdepth("sequence", robot, *SMALL, "-o", tmp_path / "none").error


def test_what_a_video_still_holds_that_breaks_off_is_computed_and_marked(softdepth, tmp_path):
    rng = np.random.default_rng(1)
    frames = [rng.integers(0, 256, (30, 96, 3), np.uint8) for _ in range(12)]
    video.write(tmp_path / "whole.webm", frames, 25)
    whole = (tmp_path / "whole.webm").read_bytes()
    (tmp_path / "cut.webm").write_bytes(whole[: len(whole) * 6 // 10])
    for name, is_cut in (("cut", True), ("whole", False)):
        out = tmp_path / name
        outcome = softdepth("sequence", tmp_path / f"{name}.webm", "--side-by-side", *SMALL, "-o", out)
        assert outcome.code == 0, outcome.err
        warnings = [line for line in outcome.err.splitlines() if line.startswith("warning: ")]
        summary = json.loads((out / "sequence.json").read_text())
        table = (out / "frames.md").read_text()
        if is_cut:
            assert 1 < summary["frames"] < 12
            said = f"cut.webm' says that it has 12 frames, {summary['frames']} can be read"
            assert said in summary["missing"]
            assert table.endswith(f"\nNot whole: {summary['missing']}.\n")
            assert len(warnings) == 2, "before the work and after it"
            assert all(said in each for each in warnings)
        else:
            assert (summary["frames"], summary["missing"], warnings) == (12, None, [])
            assert "Not whole" not in table
        assert len(list(video.Video.opened(out / "preview.webm").read())) == summary["frames"]
