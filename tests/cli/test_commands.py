"""Export, info, the lists, and the command line as a whole."""

import json
import re
import shlex
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

from softdepth.cli.info import facts
from softdepth.golden.data import datasets
from softdepth.hdl.verilog import to_verilog
from softdepth.spec.config import PRESETS, Config

SMALL = ("--disparities", 4, "--lanes", 2, "--set", "max_width=16")


def toml_in(text: str) -> str:
    """The configuration in a header comment."""
    lines = text[: text.index("\n\n")].splitlines()
    start = next(i for i, line in enumerate(lines) if "as softdepth --config reads it" in line)
    return "\n".join(line.removeprefix("//").removeprefix("   ") for line in lines[start + 1 :])


def test_export_writes_the_core_and_says_what_it_is(softdepth, tmp_path):
    path = tmp_path / "core.v"
    assert softdepth("export", "--preset", "lite", *SMALL, "-o", path).code == 0
    text = path.read_text()
    config = Config.preset("lite").override(["disparities=4", "lanes=2", "max_width=16"])
    assert config.hash in text
    assert version("softdepth") in text
    assert "module softdepth_core(" in text
    assert Config.from_dict(tomllib.loads(toml_in(text))) == config


def test_export_lists_every_port_with_its_width(softdepth):
    text = softdepth("export", *SMALL, "-o", "-").out
    module = text[text.index("module softdepth_core(") :]
    names = module[module.index("(") + 1 : module.index(")")].split(", ")
    listed = {
        name: int(bits) for bits, name in re.findall(r"^//   (?:in|out)put +(\d+)  (\w+) +\S", text, re.M)
    }
    assert sorted(listed) == sorted(names)
    assert listed["clk"] == 1
    assert f"[{listed['i_payload'] - 1}:0] i_payload;" in module
    assert re.search(r"^//   i_payload\[23:0\] +left +\S", text, re.M)
    assert re.search(r"^//   o_payload\[1:0\] +disparity +\S", text, re.M)


def test_export_does_not_depend_on_the_output(softdepth, tmp_path):
    path = tmp_path / "core.v"
    softdepth("export", *SMALL, "-o", path)
    assert softdepth("export", *SMALL, "-o", "-").out == path.read_text()


@pytest.mark.parametrize(
    ("target", "problem"),
    [
        ("no/folder/core.v", "does not exist"),
        (".", "is a folder"),
        ("file/core.v", "part of the path is a file"),
    ],
)
def test_export_where_nothing_can_be_written(softdepth, tmp_path, target, problem):
    (tmp_path / "file").write_text("mine")
    outcome = softdepth("export", *SMALL, "-o", tmp_path / target)
    assert outcome.code == 2
    assert problem in outcome.error
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


def test_export_of_what_no_part_can_hold(softdepth, tmp_path):
    least = Config.preset("paper").multipliers
    limit = f"max_multipliers={least - 1}"
    outcome = softdepth("export", "--preset", "paper", "--set", limit, "-o", tmp_path / "core.v")
    assert outcome.code == 2
    assert f"takes {least} multipliers" in outcome.error
    assert "fewer lanes" in outcome.error
    assert not list(tmp_path.iterdir())


def test_info_derives_the_figures():
    config = Config.preset("paper").override(["lanes=8", "max_width=640"])
    found = facts(config, 100, 640, 480)
    assert found["clocks per pixel"] == "8"
    assert found["clocks per frame"] == f"{640 * 480 * 8} at 640x480"
    assert found["frames per second"] == "40.7 at 100 MHz"
    assert found["smallest frame"] == "7 x 7 pixels"


@pytest.mark.parametrize("stored_rows", [0, 1, 4])
def test_info_counts_the_memories_that_are_built(stored_rows):
    config = Config.preset("sad").override(
        [
            *("disparities=4", "lanes=2", "max_width=300", "criteria.0.window=5"),
            f"stored_rows={stored_rows}",
        ]
    )
    built = {"lines": 0, "memory": 0}
    text = to_verilog(config)
    for name, body in re.findall(r"^module (\w+)\((.*?)^endmodule", text, re.MULTILINE | re.DOTALL):
        for part in built:
            if re.search(rf"_{part}_\w+$", name):
                # Lanes are equal, and their module is there once.
                copies = config.lanes if "_lane_" in name else 1
                for high, last in re.findall(r"^  .*\breg \[(\d+):0\] \w+ \[(\d+):0\];", body, re.MULTILINE):
                    built[part] += copies * (int(high) + 1) * (int(last) + 1)
    found = facts(config, 100, 300, 100)
    assert found["line buffer"] == f"{built['lines']} bits, {4 - stored_rows} lines of 300 pixel pairs"
    assert found["row memories"].startswith(f"{built['memory']} bits, {stored_rows} rows of 600 costs")
    assert built["lines"] == (4 - stored_rows) * 300 * 48
    assert built["memory"] == 2 * stored_rows * 600 * 10


def test_info_prints_them(softdepth):
    outcome = softdepth("info", "--preset", "sad", "--clock", 50, "--width", 100, "--height", 80)
    assert outcome.code == 0
    for label, text in facts(Config.preset("sad"), 50, 100, 80).items():
        assert label in outcome.out
        assert text in outcome.out


@pytest.mark.parametrize(
    "arguments", [("--width", 5), ("--width", 1281), ("--height", 1081), ("--clock", 0), ("--clock", "nan")]
)
def test_info_refuses_what_does_not_fit(softdepth, arguments):
    outcome = softdepth("info", *arguments)
    assert outcome.code == 2
    assert f"{arguments[0]} {arguments[1]} " in outcome.error


def test_info_names_all_limits_and_the_command_that_works(softdepth):
    outcome = softdepth("info", "--width", 1500, "--height", 1090)
    assert "--width 1500 --height 1090 is more than max_width = 1280 and max_height = 1080" in outcome.error
    command = shlex.split(outcome.error.partition("; run: softdepth ")[2])
    assert "1500x1090" in softdepth(*command).out


def test_lists(softdepth):
    assert softdepth("datasets").out.split() == list(datasets.names())
    presets = softdepth("presets").out
    for name in PRESETS:
        assert name in presets
        assert Config.preset(name).hash in presets


def test_version_and_help(softdepth):
    assert softdepth("--version").out == f"softdepth {version('softdepth')}\n"
    for arguments in ((), ("--help",)):
        outcome = softdepth(*arguments)
        assert outcome.code == 0
        assert "run" in outcome.out
    assert softdepth("frobnicate").error == "error: No such command 'frobnicate'; see softdepth --help"


def test_help_loads_nothing_heavy():
    script = (
        "import sys; from softdepth.cli.app import main; main(['--help']);"
        " print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in done.stderr.split()}
    assert loaded & {"typer", "softdepth"} == {"typer", "softdepth"}
    assert not loaded & {"cv2", "amaranth", "matplotlib", "skimage", "cocotb", "numpy"}


def test_ctrl_c_is_no_error(softdepth, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(Config, "preset", interrupt)
    outcome = softdepth("info")
    assert outcome.code == 130
    assert outcome.err == ""


def test_export_by_another_name_with_its_description(softdepth, tmp_path):
    path = tmp_path / "mine.v"
    assert softdepth("export", *SMALL, "--name", "mine", "-o", path).code == 0
    assert "module mine(" in path.read_text()
    assert json.loads((tmp_path / "mine.json").read_text())["module"] == "mine"
    outcome = softdepth("export", *SMALL, "--name", "no-name", "-o", tmp_path / "other.v")
    assert outcome.code == 2
    assert "--name 'no-name'" in outcome.error
    assert softdepth("export", *SMALL, "-o", tmp_path / "core.json").code == 2
    assert sorted(file.name for file in tmp_path.iterdir()) == ["mine.json", "mine.v"]


def test_export_to_a_device_leaves_nothing_beside_it(softdepth):
    assert softdepth("export", *SMALL, "-o", "/dev/null").code == 0
    assert not Path("/dev/null.json").exists()


def test_export_of_the_right_view_names_the_way_to_it(softdepth, tmp_path):
    outcome = softdepth("export", *SMALL, "--set", "reference=right", "-o", tmp_path / "core.v")
    assert outcome.code == 2
    assert "last pixel first" in outcome.error
    assert not list(tmp_path.iterdir())
