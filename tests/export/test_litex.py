"""The example's SoC of LiteX around an exported core: it elaborates, and a host on its bus runs frames."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from softdepth.export.axi_package import axi_package
from softdepth.export.bench_frames import FRAMES, bench_frames
from softdepth.export.litex_module import litex_class
from softdepth.hdl.axi.tdata import outcome_layout, pair_bits
from softdepth.sim.build import TOP, build
from softdepth.sim.stream import simulate
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import registers
from tests.export.litex_bench import BYTE, JOB_VARIABLE

CONFIG = Config.preset("sad").override(["max_width=64", "max_height=48", "disparities=8", "lanes=4"])
WISHBONE = AxiOptions(bus="wishbone")
LITEX = "/* verilator lint_off COMBDLY */"
"""LiteX assigns with ``<=`` in combinational blocks; its own simulations leave out the warning, too."""

ADDRESSES = {register.name: register.address for register in registers(CONFIG)}


def soc(options: AxiOptions, project: Path, folder: Path, old: str = "", new: str = "") -> tuple[str, dict]:
    """The Verilog of SoC and core, and LiteX's map of the addresses; with the module altered."""
    package = axi_package(CONFIG, "depth", options)
    assert old in package["depth_litex.py"]
    package["depth_litex.py"] = package["depth_litex.py"].replace(old, new)
    for file, text in package.items():
        (folder / file).write_text(text)
    command = [sys.executable, str(project / "examples" / "litex_soc.py"), str(folder), "depth", "-o", "soc"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    verilog = (folder / "soc" / "gateware" / "soc.v").read_text() + (folder / "depth.v").read_text()
    return verilog, json.loads((folder / "soc" / "csr.json").read_text())


def lines(words: str, bits: int, width: int) -> list[dict]:
    """Words of the package's bench as lines of bytes."""
    numbers = [int(word, 16) for word in words.split()]
    found = []
    for line in (numbers[start : start + width] for start in range(0, len(numbers), width)):
        assert line[-1] >> bits + 1
        data = b"".join((word % (1 << bits)).to_bytes(bits // BYTE, "little") for word in line)
        found.append({"data": data.hex(), "sof": bool(line[0] >> bits & 1)})
    return found


@pytest.mark.parametrize(
    ("name", "found"), [("depth", "DepthCore"), ("softdepth_core", "SoftdepthCore"), ("signal", "SignalCore")]
)
def test_the_class_has_a_name_of_its_own(name: str, found: str) -> None:
    assert litex_class(name) == found


def check_frames(verilog: str, addresses: dict, folder: Path) -> None:
    """Registers through the bus of the SoC, its events' CSRs, and both streams."""
    base = addresses["memories"]["depth"]["base"]
    csrs = {name: each["addr"] for name, each in addresses["csr_registers"].items()}
    frames = bench_frames(CONFIG)
    job = {
        "before": [base + ADDRESSES["IDENTITY"], csrs["depth_ev_pending"]],
        "writes": [
            [base + ADDRESSES["GEOMETRY"], frames.height << 16],
            [base + ADDRESSES["INTERRUPTS"], 1],
            [csrs["depth_ev_enable"], 1],
        ],
        "lines": lines(frames.sent, pair_bits(CONFIG.pixel), frames.width),
        "after": [base + ADDRESSES["FRAMES"], base + ADDRESSES["FLAGS"], csrs["depth_ev_pending"]],
        "clear": base + ADDRESSES["FLAGS"],
    }
    text, changed = re.subn(r"^module soc \(", f"module {TOP} (", verilog, flags=re.MULTILINE)
    assert changed == 1
    head = text.partition(");")[0]
    ways = {way: re.findall(rf"^ *{way} .*?(\w+),?$", head, re.MULTILINE) for way in ("input", "output")}
    text = f"{LITEX}\n{text}"
    program = build(text, inputs=ways["input"], outputs=ways["output"]).folder
    path = folder / "job.json"
    path.write_text(json.dumps(job))
    ended = simulate(program, "tests.export.litex_bench", folder, {JOB_VARIABLE: str(path)})
    assert ended, (folder / "log").read_text()[-2000:]
    found = json.loads(path.with_suffix(".out").read_text())
    assert found["before"] == [int.from_bytes(b"SDPT", "big"), 0]
    assert found["lines"] == lines(frames.expected, outcome_layout(CONFIG).size, frames.width)
    assert found["after"] == [FRAMES, 1, 1]
    assert found["interrupt"] == [1, 0]


@pytest.mark.slow
def test_frames_through_the_soc(project: Path, tmp_path: Path) -> None:
    check_frames(*soc(WISHBONE, project, tmp_path), tmp_path)


@pytest.mark.full
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("self.s_axis.sof", "self.s_axis.last"),
        ("self.bus.adr[:5]", "self.bus.adr[1:6]"),
        ("trigger.eq(self.irq)", "trigger.eq(self.m_axis.last)"),
    ],
)
def test_crossed_wires_are_found(project: Path, tmp_path: Path, right: str, wrong: str) -> None:
    crossed = soc(WISHBONE, project, tmp_path, right, wrong)
    with pytest.raises(AssertionError):
        check_frames(*crossed, tmp_path)


@pytest.mark.parametrize("options", [AxiOptions(), AxiOptions(inputs="two", clocks="own")])
def test_every_port_is_connected(project: Path, tmp_path: Path, options: AxiOptions) -> None:
    """On AXI4-Lite, with one stream or two, and with room for every register."""
    verilog, addresses = soc(options, project, tmp_path)
    instance = re.findall(r"^depth depth\((.*?)^\);", verilog, re.MULTILINE | re.DOTALL)
    assert len(instance) == 1
    connected = re.findall(r"\.(\w+) +\((\S.*?)\)", instance[0])
    ports = re.findall(
        r"^  (?:in|out)put (?:\[[\d:]+\] )?(\w+);",
        verilog.partition("module depth(")[2].partition("endmodule")[0],
        re.MULTILINE,
    )
    assert {name for name, _ in connected} == set(ports)
    assert addresses["memories"]["depth"]["size"] >= max(ADDRESSES.values())
