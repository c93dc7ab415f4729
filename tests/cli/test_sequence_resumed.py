"""A sequence goes on where it was stopped, and computes what has changed."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from PIL import Image

from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.truth import read_truth
from softdepth.golden.data.writers import write_picture
from softdepth.spec.config import Config
from tests.cli.recording import METRES, NAMES, SMALL, expected


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


@pytest.mark.slow
def test_robust_keeps_its_state_between_the_frames_of_a_sequence(softdepth, scene, tmp_path):
    """With every stage of post and a right winner; frame by frame as the fixed model gives it."""
    out = tmp_path / "out"
    overrides = ["disparities=8", "lanes=4", "max_width=64", "max_height=64"]
    config = Config.preset("robust").override(overrides)
    sets = [word for each in overrides for word in ("--set", each)]
    command = ("sequence", scene / "left", scene / "right", "--preset", "robust", *sets, "--engine", "rtl")
    outcome = softdepth(*command, "--processes", 1, "-o", out)
    assert outcome.code == 0, outcome.err
    assert "gateware against fixed model: 0 mismatches" in outcome.out
    for name in NAMES:
        place, model = (
            out / "frames" / name,
            expected(scene, name, config),
        )
        written = read_truth(place / "disparity.pfm").disparity
        np.testing.assert_array_equal(np.nan_to_num(written), model.pixels * model.given)
        np.testing.assert_array_equal(np.array(Image.open(place / "code.png")), model.code)
