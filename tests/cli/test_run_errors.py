"""Every mistake of a user's ends in one line with a remedy, before long work, and writes nothing."""

import os
import shlex
from pathlib import Path

import pytest

from softdepth.golden import fixed_model
from softdepth.run import report

SMALL = ("--disparities", 16, "--lanes", 4, "--engine", "fixed")


@pytest.fixture
def out(tmp_path, monkeypatch):
    """An output folder, and models that must not be reached."""

    def reached(*_):
        pytest.fail("the long work started")

    monkeypatch.setattr(fixed_model, "disparity", reached)
    return tmp_path / "new" / "out"


def refused(outcome, out: Path) -> str:
    assert outcome.code == 2
    assert not out.parent.exists(), "something was left behind"
    return outcome.error


def test_missing_file(softdepth, files, out):
    error = refused(softdepth("run", files.left, "nowhere.png", *SMALL, "-o", out), out)
    assert "'nowhere.png' does not exist" in error


def test_a_file_that_is_no_image(softdepth, files, out):
    text = files.folder / "text.png"
    text.write_text("not a picture")
    assert "text.png" in refused(softdepth("run", files.left, text, *SMALL, "-o", out), out)


def test_unreadable_file(softdepth, files, out, monkeypatch):
    def refuse(self):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refuse)
    error = refused(softdepth("run", files.left, files.right, *SMALL, "-o", out), out)
    assert "left.png" in error
    assert "Permission denied" in error


def test_sizes_that_differ(softdepth, files, out):
    right = files.cropped(files.right, 47)
    error = refused(softdepth("run", files.left, right, *SMALL, "-o", out), out)
    assert "48x30" in error
    assert "47x30" in error


@pytest.mark.parametrize(("key", "limit"), [("max_width", 47), ("max_height", 29)])
def test_larger_than_the_core(softdepth, files, out, key, limit):
    change = ("--set", f"{key}={limit}")
    error = refused(softdepth("run", files.left, files.right, *SMALL, *change, "-o", out), out)
    assert f"{key} = {limit}" in error
    assert f"--set {key}={limit + 1}" in error


def test_all_limits_at_once_with_the_command_that_works(softdepth, files, tmp_path):
    out = tmp_path / "out"
    arguments = ("--set", "max_width=47", "--set", "max_height=29", "-o", out)
    outcome = softdepth("run", files.left, files.right, *SMALL, *arguments)
    assert outcome.code == 2
    assert "max_width = 47 and max_height = 29" in outcome.error
    command = shlex.split(outcome.error.partition("; run: softdepth ")[2])
    assert softdepth(*command).code == 0
    assert (out / "report.json").exists()


@pytest.mark.parametrize("also", ["gpu", "float,rtl"])
def test_what_cannot_be_added(softdepth, files, out, also):
    error = refused(softdepth("run", files.left, files.right, *SMALL, "--also", also, "-o", out), out)
    assert f"--also {also}" in error


def test_smaller_than_the_windows(softdepth, files, out):
    left, right = (files.cropped(path, 5) for path in (files.left, files.right))
    error = refused(softdepth("run", left, right, *SMALL, "-o", out), out)
    assert "5x30" in error
    assert "7x7" in error


def test_lanes_that_do_not_divide(softdepth, files, out):
    error = refused(softdepth("run", files.left, files.right, "--lanes", 5, "-o", out), out)
    assert "lanes is 5" in error
    assert "use one of 1, 2, 4" in error


def test_unknown_preset(softdepth, files, out):
    error = refused(softdepth("run", files.left, files.right, "--preset", "papre", "-o", out), out)
    assert "unknown preset 'papre'" in error
    assert "paper" in error


@pytest.mark.parametrize("text", ["lains = 4\n", "lanes = \n", "lanes = 'four'\n"])
def test_bad_configuration_file(softdepth, files, out, tmp_path, text):
    path = tmp_path / "core.toml"
    path.write_text(text)
    error = refused(softdepth("run", files.left, files.right, "--config", path, "-o", out), out)
    assert "lains" in error or "core.toml" in error or "lanes = 'four'" in error


def test_missing_configuration_file(softdepth, files, out):
    error = refused(softdepth("run", files.left, files.right, "--config", "no.toml", "-o", out), out)
    assert "no.toml" in error


@pytest.mark.parametrize("change", ["lains=4", "lanes", "criteria.7.window=3"])
def test_bad_override(softdepth, files, out, change):
    error = refused(softdepth("run", files.left, files.right, "--set", change, "-o", out), out)
    assert change.partition("=")[0] in error


def test_preset_and_file_together(softdepth, files, out, tmp_path):
    path = tmp_path / "core.toml"
    path.write_text("lanes = 4\n")
    both = ("--preset", "paper", "--config", path)
    error = refused(softdepth("run", files.left, files.right, *both, "-o", out), out)
    assert "give one of the two" in error


def test_truth_of_another_size(softdepth, files, out):
    truth = files.cropped_truth(47)
    error = refused(softdepth("run", files.left, files.right, "--gt", truth, *SMALL, "-o", out), out)
    assert "47x30" in error


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ((), "0 given"),
        (("left.png",), "1 given"),
        (("left.png", "right.png", "--dataset", "motorcycle"), "--dataset motorcycle"),
        (("--dataset", "motorcycle", "--gt", "truth.pfm"), "--dataset motorcycle"),
        (("--dataset", "tedy"), "unknown dataset 'tedy'"),
        (("left.png", "right.png", "--gt-scale", "4"), "--gt-scale 4 without --gt"),
        (("left.png", "right.png", "--engine", "gpu"), "'gpu'"),
        (("left.png", "right.png", "third.png"), "third.png"),
    ],
)
def test_contradicting_arguments(softdepth, out, arguments, problem):
    assert problem in refused(softdepth("run", *arguments, "-o", out), out)


def test_output_is_a_file(softdepth, files, out, tmp_path):
    path = tmp_path / "taken"
    path.write_text("mine")
    outcome = softdepth("run", files.left, files.right, *SMALL, "-o", path)
    assert outcome.code == 2
    assert str(path) in outcome.error
    assert path.read_text() == "mine"


def test_a_parent_of_the_output_is_a_file(softdepth, files, out, tmp_path):
    (tmp_path / "taken").write_text("mine")
    outcome = softdepth("run", files.left, files.right, *SMALL, "-o", tmp_path / "taken" / "out")
    assert outcome.code == 2
    assert "taken" in outcome.error


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_no_permission(softdepth, files, out, tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    outcome = softdepth("run", files.left, files.right, *SMALL, "-o", folder / "out")
    assert outcome.code == 2
    assert "permission denied" in outcome.error


def test_no_permission_as_the_system_tells_it(softdepth, files, out, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.mkdtemp", refuse)
    error = refused(softdepth("run", files.left, files.right, *SMALL, "-o", out), out)
    assert "permission denied" in error
    assert "-o" in error


def test_no_compiler(softdepth, files, out, monkeypatch):
    monkeypatch.setenv("PATH", "")
    arguments = ("--disparities", 16, "--lanes", 4, "-o", out)
    error = refused(softdepth("run", files.left, files.right, *arguments), out)
    assert "'g++' is not on PATH" in error
    assert "apt" in error


def test_more_multipliers_than_the_part_has(softdepth, files, out):
    arguments = (*SMALL, "--operator", "prod", "--set", "max_multipliers=25", "-o", out)
    assert "takes 26 multipliers" in refused(softdepth("run", files.left, files.right, *arguments), out)


def test_a_failure_on_the_way_keeps_the_earlier_result(softdepth, files, tmp_path, monkeypatch):
    out = tmp_path / "out"
    command = ("run", files.left, files.right, *SMALL, "-o", out)
    assert softdepth(*command).code == 0
    before = {file.name: file.read_bytes() for file in out.iterdir()}
    beside = sorted(tmp_path.iterdir())

    def full(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(report, "write", full)
    assert softdepth(*command).code == 130
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before
    assert sorted(tmp_path.iterdir()) == beside
