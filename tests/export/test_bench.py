"""The bench in the package: it passes as it is, by FuseSoC too, and finds a core that is broken."""

import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

from softdepth.export.axi_package import axi_package
from softdepth.spec.axi_options import DEFAULT, AxiOptions
from softdepth.spec.config import Config
from tests.support.fusesoc import fusesoc
from tests.support.icarus import needs_icarus

SIZE = ["max_width=64", "max_height=48", "disparities=8", "lanes=4"]
TWO = AxiOptions(inputs="two", clocks="own", left=True)
CORES: dict[str, tuple[Config, AxiOptions]] = {
    "sad": (Config.preset("sad").override(SIZE), DEFAULT),
    "negative": (Config.preset("sad").override([*SIZE, "min_disparity=-3", "pixel=rgb10"]), TWO),
    # Sixteenths, confidence, check, island, filling and both medians.
    "robust": (
        Config.preset("robust-small").override([*SIZE, "pixel=gray12", "disparities=4"]),
        AxiOptions(bus="wishbone", left=True),
    ),
}
BROKEN = {
    "a bit of the result": (
        r"assign m_axis_tdata = (.*);",
        r"assign m_axis_tdata = (\1) ^ 1;",
        "frame 0, y 0, x 0",
    ),
    "a lost marker": (r"assign m_axis_tuser = .*;", "assign m_axis_tuser = 0;", "frame 0, y 0, x 0"),
    "no pixel comes in": (r"\.i__valid\(s_axis_tvalid\)", ".i__valid(1'b0)", "FAIL: no word for"),
    "an unknown bit": (r"assign m_axis_tlast = .*;", "assign m_axis_tlast = 1'bx;", "frame 0, y 0, x 0"),
    "no interrupt": (r"assign irq = .*;", "assign irq = 0;", "irq is 0"),
    "another identity": (r"255'h2", "255'h3", "register 00 is 73445054, not 53445054"),
}


@cache
def package(name: str) -> dict[str, str]:
    """The files of one of `CORES`."""
    config, options = CORES[name]
    return axi_package(config, "depth", options)


def written(name: str, folder: Path) -> Path:
    """The same in a folder."""
    for file, text in package(name).items():
        (folder / file).write_text(text)
    return folder


def bench(folder: Path) -> subprocess.CompletedProcess[str]:
    """The commands in the bench's head."""
    ((command,),) = [re.findall(r"\$ (iverilog .*)", (folder / "depth_bench.sv").read_text())]
    return subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True, check=False)


@needs_icarus
@pytest.mark.parametrize("name", CORES)
def test_icarus_runs_it(name: str, tmp_path: Path) -> None:
    done = bench(written(name, tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.match(r"PASS: \d+ words equal the model's", done.stdout)
    assert not done.stderr


@needs_icarus
@pytest.mark.parametrize("fault", BROKEN)
def test_it_finds_a_broken_core(fault: str, tmp_path: Path) -> None:
    old, new, said = BROKEN[fault]
    core = written("sad", tmp_path) / "depth.v"
    text, changed = re.subn(old, new, core.read_text(), count=1)
    assert changed
    core.write_text(text)
    done = bench(tmp_path)
    assert done.returncode != 0
    assert said in done.stdout
    assert "PASS" not in done.stdout


def test_it_sends_what_differs_and_expects_what_differs(tmp_path: Path) -> None:
    """A bench of equal words would find nothing."""
    written("robust", tmp_path)
    for file in ("depth_bench_in.hex", "depth_bench_out.hex"):
        words = (tmp_path / file).read_text().split()
        assert len(set(words)) > len(words) / 8, file


@needs_icarus
def test_fusesoc_runs_it_in_icarus(tmp_path: Path) -> None:
    folder = tmp_path / "ip"
    folder.mkdir()
    done = fusesoc(written("sad", folder), tmp_path, "sim-icarus")
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]
    assert "PASS: " in done.stdout + done.stderr


@pytest.mark.slow
def test_fusesoc_runs_it_in_verilator(tmp_path: Path) -> None:
    """As it is, and with a word that is not the model's."""
    folder = tmp_path / "ip"
    folder.mkdir()
    done = fusesoc(written("sad", folder), tmp_path, "sim")
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]
    assert "PASS: " in done.stdout + done.stderr
    (words,) = tmp_path.glob("build/*/sim/depth_bench_out.hex")
    first, _, rest = words.read_text().partition("\n")
    words.write_text(f"{int(first, 16) ^ 1:x}\n{rest}")
    (program,) = words.parent.glob("Vdepth_bench")
    again = subprocess.run([program], cwd=words.parent, capture_output=True, text=True, check=False)
    assert again.returncode != 0
    assert "FAIL: 1 differences" in again.stdout
