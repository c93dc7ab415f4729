"""The package with AXI streams, as those who take it in use it."""

import re
import subprocess
from pathlib import Path

import pytest

from softdepth.cli.app import main
from softdepth.export.axi_package import axi_package
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import registers
from tests.support.fusesoc import fusesoc

SMALL = Config.preset("sad").override(["max_width=64", "max_height=48", "disparities=8", "lanes=4"])


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("package")
    SMALL.save(folder / "small.toml")
    target = folder / "ip"
    main(
        [
            "export",
            "--ip",
            "axi",
            "--config",
            str(folder / "small.toml"),
            "--name",
            "depth",
            "-o",
            str(target),
        ]
    )
    return target


def test_fusesoc_lints(package: Path, tmp_path: Path) -> None:
    done = fusesoc(package, tmp_path, "lint")
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]


@pytest.mark.slow
def test_fusesoc_lints_every_stage_two_streams_and_wishbone(tmp_path: Path) -> None:
    """With the check, the island test, sixteenths, confidence, filling and both medians."""
    config = Config.preset("robust-small").override(
        ["max_width=64", "max_height=48", "disparities=4", "lanes=4", "pixel=gray8", "post.median=5"]
    )
    config.save(tmp_path / "small.toml")
    target = tmp_path / "ip"
    chosen = ["--config", str(tmp_path / "small.toml"), "--name", "depth", "-o", str(target)]
    streams = ["--inputs", "two", "--skew", "1", "--clocks", "own"]
    main(["export", "--ip", "axi", "--bus", "wishbone", *streams, *chosen])
    done = fusesoc(target, tmp_path, "lint")
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]


def test_fusesoc_would_say_so(package: Path, tmp_path: Path) -> None:
    core = package / "depth.v"
    text = core.read_text()
    latch = "  reg latched_here; always @* if (aclk) latched_here = irq;\nendmodule"
    head, _, rest = text.partition("module depth(")
    core.write_text(f"{head}module depth({rest.replace('endmodule', latch, 1)}")
    try:
        done = fusesoc(package, tmp_path, "lint")
        assert done.returncode
        assert "%Warning-LATCH" in done.stdout + done.stderr
    finally:
        core.write_text(text)


def test_a_c_compiler_reads_the_header(package: Path, tmp_path: Path) -> None:
    places = "\n".join(
        f'_Static_assert(offsetof(softdepth_t, {r.name}) == {r.address}, "{r.name}");'
        for r in registers(SMALL)
    )
    (tmp_path / "test.c").write_text(f'#include <stddef.h>\n#include "registers.h"\n{places}\n')
    subprocess.run(["gcc", "-std=c11", "-fsyntax-only", f"-I{package}", "test.c"], cwd=tmp_path, check=True)


def test_the_templates_have_every_port(package: Path) -> None:
    ports = re.findall(
        r"^  (?:in|out)put (?:\[[\d:]+\] )?(\w+);", (package / "depth.v").read_text(), re.MULTILINE
    )
    for file in ("depth_instance.v", "depth_instance.vhd"):
        text = (package / file).read_text()
        assert all(
            port in re.findall(r"\w+", text) for port in ("aclk", "s_axis_tdata", "irq", *ports[:3])
        ), file


@pytest.mark.parametrize(("file", "every"), [("depth.sdc", "*"), ("depth.xdc", "[*]")])
def test_the_constraints_name_every_port(package: Path, file: str, every: str) -> None:
    """Read by a Tcl interpreter, whose commands of the tools say what they were given."""
    tkinter = pytest.importorskip("tkinter", reason="Python has no Tcl: sudo apt install python3-tk")
    tcl = tkinter.Tcl()
    named: dict[str, set[str]] = {}
    for command in ("create_clock", "set_input_delay", "set_output_delay"):
        tcl.createcommand(command, lambda *words, at=command: named.setdefault(at, set()).update(words))
    tcl.createcommand("get_ports", lambda names: names)
    tcl.eval((package / file).read_text())
    sides = {"input": set[str](), "output": set[str]()}
    head = (package / "depth.v").read_text().partition("module depth(")[2].partition("endmodule")[0]
    for side, bits, name in re.findall(r"^  (input|output) (\[[\d:]+\] )?(\w+);", head, re.MULTILINE):
        sides[side].add(f"{name}{every}" if bits else name)
    assert len(sides["input"]) > 10
    assert "aclk" in named["create_clock"]
    for side, ports in sides.items():
        (given,) = (word for word in named[f"set_{side}_delay"] if "tvalid" in word)
        assert set(given.split()) == ports - {"aclk"}


@pytest.mark.parametrize(("file", "every"), [("depth.sdc", "*"), ("depth.xdc", "[*]")])
def test_constraints_of_each_clock(file: str, every: str) -> None:
    """Every port but the clocks is named once, with its own."""
    text = axi_package(SMALL, "depth", AxiOptions(inputs="two", clocks="own"))[file]
    named = {
        (way, clock): ports.split()
        for way, clock, ports in re.findall(r"set_(in|out)put_delay +-clock (\w+) .*\{([^{}]*)\}\]", text)
    }
    clocks = ["aclk", "s_axis_left_aclk", "s_axis_right_aclk"]
    assert sorted(re.findall(r"create_clock -name (\w+)", text)) == clocks
    assert named["in", "s_axis_right_aclk"] == [
        f"s_axis_right_t{n}" for n in (f"data{every}", "valid", "user", "last")
    ]
    assert named["out", "s_axis_left_aclk"] == ["s_axis_left_tready"]
    assert {"aresetn", "m_axis_tready", f"s_axil_wdata{every}"} <= {*named["in", "aclk"]}
    assert not any(port.startswith("s_axis_") for port in named["in", "aclk"] + named["out", "aclk"])


def test_wishbone_in_place_of_axi_lite() -> None:
    text = axi_package(SMALL, "depth", AxiOptions(bus="wishbone"))["depth_instance.v"]
    assert ".wb_ack(wb_ack)" in text
    assert "s_axil" not in text
