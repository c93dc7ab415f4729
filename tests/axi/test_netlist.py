"""The synthesised netlist of the whole AXI core is exact bit for bit, and one with a wrong bit is not."""

import copy
import tempfile
from pathlib import Path

import numpy as np
import pytest

from softdepth.flow.netlist_verilog import netlist_verilog
from softdepth.flow.synthesis import TOP, Netlist, synthesise
from softdepth.hdl.axi.core import AxiCore
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from tests.axi.runs import Design, Steps, built, expected, run
from tests.cocotb.scenes import textured

pytestmark = pytest.mark.full

SAD = Design(
    Config.preset("sad").override(["max_width=1024", "max_height=12", "disparities=4", "lanes=2"]),
    AxiOptions(left=True),
)
"""Wide enough for block RAM, as in a core of full size."""


@pytest.fixture(scope="module")
def netlist() -> Netlist:
    with tempfile.TemporaryDirectory() as folder:
        return synthesise(AxiCore(SAD.config, SAD.options), "ecp5", Path(folder))


def check(netlist: Netlist, folder: Path) -> None:
    """Frames with pauses on both sides, settings written in mid-frame, registers and the interrupt."""
    steps, wanted, invalid = Steps(SAD), [], 0
    steps.write("INTERRUPTS", 1)
    for number, (height, width) in enumerate([(9, 24), (7, 12), (6, 20)]):
        left, right = textured(height, width, number)
        wanted.append(expected(left, right, SAD.config, invalid=invalid, pixels=True))
        steps.lines(left, right, range(4))
        invalid = 0x5A5 * (number + 1)
        steps.write("INVALID", invalid)
        steps.lines(left, right, range(4, height))
    steps.lines(*textured(2, 10, 99), range(2))
    core = built(SAD, netlist_verilog(netlist))
    out = run(steps, folder, seed=2, idle=0.2, pressure=0.3, core=core)
    assert len(out.frames) >= len(wanted)
    for got, want in zip(out.frames, wanted, strict=False):
        assert np.array_equal(got, want)
    assert out.registers["FRAMES"] == len(wanted)
    assert out.registers["FLAGS"] == 1
    assert out.registers["IDENTITY"].to_bytes(4, "big") == b"SDPT"
    assert f"{out.registers['CONFIG_HIGH']:04x}{out.registers['CONFIG_LOW']:08x}" == SAD.config.hash
    assert out.irq == 1


def test_the_netlist_is_exact(netlist: Netlist, tmp_path: Path) -> None:
    kinds = {cell["type"] for cell in netlist["modules"][TOP]["cells"].values()}
    assert {"LUT4", "CCU2C", "TRELLIS_FF", "DP16KD"} <= kinds
    check(netlist, tmp_path)


@pytest.mark.parametrize(
    ("part", "kind", "parameter"), [(".sad.", "CCU2C", "INIT0"), ("left", "DP16KD", "REGMODE_B")]
)
def test_a_wrong_bit_is_found(netlist: Netlist, tmp_path: Path, part: str, kind: str, parameter: str) -> None:
    """In the sums, and in the memory of the left view's pixels."""
    broken = copy.deepcopy(netlist)
    cells = sorted(broken["modules"][TOP]["cells"].items())
    found = [cell for name, cell in cells if part in name and cell["type"] == kind]
    assert found
    for cell in found:
        value = cell["parameters"][parameter]
        if parameter.startswith("REGMODE"):
            cell["parameters"][parameter] = {"OUTREG": "NOREG", "NOREG": "OUTREG"}[value]
        else:
            cell["parameters"][parameter] = "".join("10"[int(bit)] for bit in value)
    with pytest.raises(AssertionError):
        check(broken, tmp_path)
