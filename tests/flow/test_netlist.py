"""The synthesised netlist computes what the fixed model does, and a netlist with one wrong bit does not."""

import copy

import pytest

from softdepth.flow.netlist_verilog import netlist_verilog
from softdepth.flow.synthesis import TOP, Netlist, cells, core_netlist
from softdepth.golden import fixed_model
from softdepth.golden.data import datasets
from softdepth.sim.compare import Mismatch, mismatches
from softdepth.sim.frames import run_frames
from softdepth.spec.config import Config
from softdepth.spec.errors import ToolError
from tests.flow.conftest import SMALL

CROP = (slice(200, 224), slice(300, 364))
"""Rows and columns of Motorcycle: edges at several depths."""


WIDE = Config.preset("sad").override(["disparities=4", "lanes=2", "max_width=1280", "stored_rows=1"])
"""Lines as long as users have them: block RAMs of 2, 4 and 9 bits, with the registers they have inside."""


def compare(netlist: Netlist, config: Config = SMALL) -> list[Mismatch]:
    """Where a core's netlist differs from the fixed model on a crop of a real image."""
    pair = datasets.load("motorcycle")
    left, right = pair.left[CROP], pair.right[CROP]
    expected = fixed_model.disparity(left, right, config)
    assert len(set(expected.disparity.ravel().tolist())) == config.disparities, "the crop is too plain"
    found = run_frames(config, [(left, right)], verilog=netlist_verilog(netlist))
    return list(mismatches([expected], found.maps))


@pytest.mark.slow
def test_the_netlist_equals_the_fixed_model(small_netlist):
    assert compare(small_netlist) == []


@pytest.mark.slow
def test_block_ram_with_its_own_registers():
    """They are used, and taken for one clock more or less they would shift the image."""
    netlist = core_netlist(WIDE)
    memories = [c for c in netlist["modules"][TOP]["cells"].values() if c["type"] == "DP16KD"]
    modes = [(c["parameters"]["REGMODE_A"], c["parameters"]["REGMODE_B"]) for c in memories]
    assert len(modes) > 4
    assert all("OUTREG" in mode for mode in modes)
    assert {int(c["parameters"]["DATA_WIDTH_B"], 2) for c in memories} == {2, 4, 9}
    assert compare(netlist, WIDE) == []
    for cell in memories:
        cell["parameters"]["REGMODE_B"] = cell["parameters"]["REGMODE_A"] = "NOREG"
    assert compare(netlist, WIDE), "without the registers nothing changed"


@pytest.mark.slow
def test_multipliers_with_their_own_registers(small_netlist):
    """They are used on both sides, and without them candidates of other clocks would be compared."""
    broken = copy.deepcopy(small_netlist)
    found = [c for c in broken["modules"][TOP]["cells"].values() if c["type"] == "MULT18X18D"]
    for cell in found:
        for register in ("INPUTA", "INPUTB", "OUTPUT"):
            assert cell["parameters"].pop(f"REG_{register}_CLK") == "CLK0"
    assert found
    assert compare(broken), "without the registers nothing changed"


@pytest.mark.slow
def test_products_of_prod_have_a_clock_of_their_own():
    """Each multiplier has registers on all sides, those of the rules as well as those of comparisons."""
    config = SMALL.override(["operator=prod"])
    netlist = core_netlist(config)
    found = [c for c in netlist["modules"][TOP]["cells"].values() if c["type"] == "MULT18X18D"]
    assert len(found) == config.multipliers > SMALL.multipliers
    for cell in found:
        for register in ("INPUTA", "INPUTB", "OUTPUT"):
            assert cell["parameters"].get(f"REG_{register}_CLK") == "CLK0"
    assert compare(netlist, config) == []


@pytest.mark.slow
def test_the_netlist_holds_every_kind_of_cell(small_netlist):
    """What is simulated is the mapped design, hard blocks included."""
    found = cells(small_netlist)
    assert {"LUT4", "CCU2C", "TRELLIS_FF", "DP16KD", "MULT18X18D"} <= set(found)
    assert not [kind for kind in found if kind.startswith("$")]


@pytest.mark.slow
def test_one_wrong_bit_in_a_lookup_table_is_found(small_netlist):
    broken = copy.deepcopy(small_netlist)
    name, cell = next(
        (name, cell)
        for name, cell in sorted(broken["modules"][TOP]["cells"].items())
        if ".lane_0.cost" in name and cell["type"] == "CCU2C"
    )
    # The word for inputs that are all 0, but for those that are always 1.
    at = sum(1 << k for k, pin in enumerate("ABCD") if cell["connections"][f"{pin}0"] == ["1"])
    table = [*cell["parameters"]["INIT0"]]
    table[-1 - at] = "0" if table[-1 - at] == "1" else "1"
    cell["parameters"]["INIT0"] = "".join(table)
    assert compare(broken), f"table of {name}"


@pytest.mark.slow
def test_initial_values_in_block_ram_are_refused(small_netlist):
    filled = copy.deepcopy(small_netlist)
    memory = next(c for c in filled["modules"][TOP]["cells"].values() if c["type"] == "DP16KD")
    memory["parameters"]["INITVAL_07"] = "1" + memory["parameters"]["INITVAL_07"][1:]
    with pytest.raises(ToolError, match="has initial values"):
        netlist_verilog(filled)
