"""No command replaces or removes a file that it reads: each refuses before long work, and names the file."""

import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

from softdepth.spec.config import Config
from tests.cli.conftest import Files
from tests.rig import rigs

PAIR = ("left.png", "right.png")
SMALL = ("--disparities", "16", "--lanes", "4")
CAMERAS = ("--focal", "40", "--baseline", "0.1")
NAMED: dict[str, tuple[str, Sequence[str]]] = {
    "run, left": ("overview.png", ("run", "overview.png", "right.png", "-o", ".")),
    "run, right": ("colour.png", ("run", "left.png", "colour.png", "-o", ".")),
    "run, both": ("code.png", ("run", "code.png", "--side-by-side", "-o", ".")),
    "run, truth": ("disparity.pfm", ("run", *PAIR, "--gt", "disparity.pfm", "-o", ".")),
    "run, truth that is only removed": ("depth.pfm", ("run", *PAIR, "--gt", "depth.pfm", "-o", ".")),
    "run, configuration": ("config.toml", ("run", *PAIR, "--config", "config.toml", "-o", ".")),
    "run, calibration": ("report.json", ("run", *PAIR, "--calibration", "report.json", "-o", ".")),
    "run, raw": ("calibration.yml", ("run", *PAIR, "--rectify", "calibration.yml", "-o", ".")),
    "compare": ("differences.png", ("compare", "left.png", "differences.png", "-o", ".")),
    "compare, configuration": ("config.toml", ("compare", *PAIR, "--config", "config.toml", "-o", ".")),
    "board": ("overview.png", ("board", "--port", "none", "overview.png", "right.png", "-o", ".")),
    "rectify": ("left.png", ("rectify", *PAIR, "--calibration", "rig.yml", "-o", ".")),
    "view, left": ("left.png", ("view", *PAIR, *CAMERAS, "-o", "left.png")),
    "view, configuration": ("own.toml", ("view", *PAIR, "--config", "own.toml", *CAMERAS, "-o", "own.toml")),
    "view, raw": ("rig.yml", ("view", *PAIR, "--rectify", "rig.yml", "-o", "rig.yml")),
    "export": ("core.v", ("export", "--config", "core.v", "-o", "core.v")),
    "export, description": ("core.json", ("export", "--config", "core.json", "-o", "core.v")),
    "build": ("config.toml", ("build", "--board", "icebreaker", "--config", "config.toml", "-o", ".")),
}
"""A file that is read and would be written, and the command line."""


@pytest.fixture
def here(files: Files, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The pair's folder, in which the commands run and write."""
    monkeypatch.chdir(files.folder)
    rigs.opencv(files.folder / "rig.yml", 0.001)
    return files.folder


def content(name: str, here: Path) -> bytes:
    """What a file of this name holds, by what it is."""
    if name.endswith((".toml", ".v", ".json")) and name != "report.json":
        return Config.preset("lite").override(["disparities=16", "lanes=4"]).to_toml().encode()
    if name.endswith(".pfm"):
        return (here / "truth.pfm").read_bytes()
    return (here / ("left.png" if name.endswith(".png") else "rig.yml")).read_bytes()


@pytest.mark.parametrize("case", NAMED)
@pytest.mark.parametrize("linked", [False, True], ids=["itself", "through a link"])
def test_what_is_read_stays(softdepth, here: Path, tmp_path: Path, case: str, linked: bool) -> None:
    name, command = NAMED[case]
    target = here / name
    if linked:
        real = tmp_path / "elsewhere"
        real.write_bytes(content(name, here))
        target.unlink(missing_ok=True)
        target.symlink_to(real)
        # It is read where it lies, and would be replaced through the link.
        command = [
            str(real) if part == name and command[k - 1] != "-o" else part for k, part in enumerate(command)
        ]
    else:
        target.write_bytes(content(name, here))
    before = {path: path.read_bytes() for path in here.iterdir()}
    small = () if "--config" in command or command[0] == "rectify" else ("--preset", "lite", *SMALL)
    outcome = softdepth(*command, *small)
    assert outcome.code == 2, outcome.err
    assert "would replace" in outcome.error
    assert (str(tmp_path / "elsewhere") if linked else name) in outcome.error
    assert {path: path.read_bytes() for path in here.iterdir()} == before


def test_what_is_not_read_is_replaced(softdepth, here: Path) -> None:
    shutil.copy(here / "left.png", here / "overview.png")
    outcome = softdepth("run", *PAIR, "--preset", "sad", *SMALL, "--engine", "fixed", "-o", ".")
    assert outcome.code == 0, outcome.err
    assert (here / "overview.png").read_bytes() != (here / "left.png").read_bytes()
