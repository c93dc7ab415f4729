"""What is wrong with a sequence is told in a line, and nothing is written."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from softdepth.golden.data.images import read_pair
from softdepth.golden.data.writers import write_picture
from softdepth.sequence import video
from tests.cli.recording import METRES, SMALL


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
        (twice, (), "would give results of the same name"),
        (None, ("--fps", 0), "--fps 0 is not a rate"),
        (None, ("--gt-scale", 2), "--gt-scale 2 without --gt"),
        (None, ("--min-confidence", 3), "has no confidence"),
        (None, ("--disparity-error", 1), "the cameras are not known"),
        (None, ("--disparity-error", "nan", *METRES), "--disparity-error nan is not an error"),
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
        (tmp_path / "no.mp4", tmp_path / "no.mp4"): "is not a video that OpenCV can open",
        (tmp_path / "*.bmp", tmp_path / "*.png"): "no file matches",
        (tmp_path / "empty", tmp_path / "empty"): "holds no images",
        (tmp_path / "empty",): "holds no rig",
        (tmp_path / "nothing",): "does not exist",
        (tmp_path / "*.png",): "is one view",
        (tmp_path / "short.webm", tmp_path / "long.webm"): "has 2 frames,",
        (tmp_path / "short.webm", scene / "left"): "is a video,",
        (scene / "left" / "f8.png", scene / "right"): "is one image",
        (tmp_path / "long.webm", "--side-by-side", "--top-bottom"): "contradict each other",
        (scene / "left", scene / "right", "--frame-id", "a b", *METRES): "is not a name",
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
    assert "is not a frame of softdepth's" in outcome.error
    assert softdepth("run", scene / "left", scene / "right", *SMALL[:-2]).error.endswith("sequence for more")
