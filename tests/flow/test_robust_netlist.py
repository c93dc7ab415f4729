"""The synthesised netlist of a core with every stage computes what the fixed model does, a broken one not."""

import copy

import pytest

from softdepth.flow.netlist_verilog import netlist_verilog
from softdepth.flow.synthesis import TOP, Netlist, core_netlist
from softdepth.golden import fixed_model
from softdepth.sim.compare import Mismatch, mismatches
from softdepth.sim.frames import run_frames
from softdepth.spec.config import Config
from tests.cocotb.scenes import textured

pytestmark = pytest.mark.full

ROBUST = Config.preset("robust").override(
    [
        *("disparities=4", "lanes=2", "max_width=256", "max_height=64"),
        *("criteria.0.rows=3", "criteria.0.taps=3", "criteria.0.spacing=2"),
        *("criteria.1.rows=3", "criteria.1.columns=3", "criteria.1.running_sums=false"),
        "post.masked_median=1",
    ]
)
"""Every block of `robust`, with smaller windows; column sums of one criterion in block RAM, of one anew."""

SMALL = Config.preset("robust-small").override(
    [
        *("disparities=4", "lanes=1", "max_width=1280", "max_height=64"),
        *("criteria.0.rows=3", "criteria.0.columns=7", "post.masked_median=4", "post.masked_rows=2"),
    ]
)
"""The same of `robust-small`, whose colours are coarse."""

FRAMES = [textured(7, 20, 1), textured(5, 12, 2)]


@pytest.fixture(scope="module")
def netlist() -> Netlist:
    return core_netlist(ROBUST)


def compare(netlist: Netlist, config: Config = ROBUST) -> list[Mismatch]:
    """Where a netlist differs from the fixed model on frames back to back."""
    expected = [fixed_model.disparity(*pair, config) for pair in FRAMES]
    assert {0, 1, 3} <= {int(code) for each in expected for code in each.code.ravel()}
    found = run_frames(config, FRAMES, verilog=netlist_verilog(netlist))
    return list(mismatches(expected, found.maps))


def has_output_registers(netlist: Netlist) -> bool:
    """Whether some block RAM uses its own."""
    cells = netlist["modules"][TOP]["cells"].values()
    memories = [cell["parameters"] for cell in cells if cell["type"] == "DP16KD"]
    return any("OUTREG" in (p["REGMODE_A"], p["REGMODE_B"]) for p in memories)


def test_the_netlist_equals_the_fixed_model(netlist: Netlist) -> None:
    assert has_output_registers(netlist)
    assert compare(netlist) == []


def test_the_netlist_of_the_small_core() -> None:
    small = core_netlist(SMALL)
    assert has_output_registers(small)
    assert compare(small, SMALL) == []


def test_block_ram_without_its_registers_is_found(netlist: Netlist) -> None:
    """The windows' words then come a clock early."""
    broken = copy.deepcopy(netlist)
    cells = broken["modules"][TOP]["cells"]
    memories = [cell for name, cell in cells.items() if cell["type"] == "DP16KD" and "island" in name]
    assert memories
    for cell in memories:
        cell["parameters"]["REGMODE_A"] = cell["parameters"]["REGMODE_B"] = "NOREG"
    assert compare(broken)
