"""Rows of the table of area and speed: what they hold, how they follow from nextpnr, when they are made."""

import pytest
from amaranth.sim import Simulator

from softdepth.flow.blocks import blocks
from softdepth.flow.limits import taken
from softdepth.flow.measuring_top import MeasuringTop
from softdepth.flow.synthesis import TOP, synthesise
from softdepth.flow.tools import Tool
from softdepth.spec.config import Config
from softdepth.studies import utilization
from softdepth.studies.utilization import Selection
from tests.studies.rows import KEYS, row


def test_a_row_has_the_documented_keys_and_figures():
    assert row().model_dump() == {
        "device": "LFE5U-85F-6",
        "preset": "paper",
        "operator": "mean",
        "disparities": 64,
        "lanes": 16,
        "width": 1280,
        "lut4": 8000,
        "ff": 9000,
        "ebr": 12,
        "dsp": 34,
        "fmax_mhz": 125.0,
        "cycles_per_pixel": 4,
        "mpixel_s": 31.25,
        "mde_s": 2000.0,
        "mde_s_per_klut": 250.0,
        "lut4_per_lane": 500.0,
    }
    assert " ".join(row().model_dump()) == KEYS


def test_the_measuring_top_reads_every_output_and_feeds_every_input():
    """Bits shifted in appear at the core's ports; the core's ports appear in what is shifted out."""
    config = Config.preset("sad").override(["disparities=4", "lanes=1", "max_width=16", "max_height=16"])
    top = MeasuringTop(config)
    inputs, outputs = len(top.inputs), len(top.outputs)
    assert top.flip_flops == inputs + 2 * outputs
    # Pixels without a start of frame: the core takes them, and counts that the start was missing.
    pattern = [int(k % 3 == 0 and k < 48) for k in range(inputs)]
    pattern[inputs - 2 :] = [1, 1]

    async def bench(ctx):
        for bit in reversed(pattern):
            ctx.set(top.serial_in, bit)
            await ctx.tick()
        seen = ctx.get(top.inputs)
        assert [(seen >> k) & 1 for k in range(inputs)] == pattern
        await ctx.tick().repeat(20)
        expected = ctx.get(top.outputs)
        await ctx.tick()
        ctx.set(top.load, 1)
        await ctx.tick()
        ctx.set(top.load, 0)
        bits = []
        for _ in range(outputs):
            bits.append(ctx.get(top.serial_out))
            await ctx.tick()
        assert sum(bit << k for k, bit in enumerate(bits)) == expected != 0

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()


@pytest.mark.slow
def test_blocks_account_for_every_cell(tmp_path):
    config = Config.preset("sad").override(["disparities=4", "lanes=2", "max_width=16", "max_height=16"])
    netlist = synthesise(MeasuringTop(config), "ecp5", tmp_path)
    found = {block.name: block for block in blocks(netlist)}
    total = taken(netlist)
    for resource in ("lut4", "ff", "ebr"):
        assert sum(getattr(block, resource) for block in found.values()) == total[resource]
    assert {"top", "core.front.guard", "core.costs.lane.sad", "core.costs.sequencer"} <= set(found)
    assert found["core.costs.lane.sad"].ff > found["core.front.guard"].ff > 0
    assert len(netlist["modules"][TOP]["ports"]) == 5


def test_a_netlist_is_placed_and_routed_once(runs):
    one, two = (Selection(preset="lite", operator="mean", lanes=n).config() for n in (4, 8))
    first = utilization.measure(one, "lite")
    assert utilization.measure(one, "lite") == first
    assert runs == [1]
    assert utilization.measure(two, "lite").key != first.key
    assert utilization.measure(one, "lite", seed=2).key != first.key
    assert runs == [1, 1, 2]
    runs.gateware = "changed"
    assert utilization.measure(one, "lite").key != first.key
    assert runs == [1, 1, 2, 1]


def test_another_nextpnr_measures_again(runs, monkeypatch):
    config = Selection(preset="lite", operator="mean", lanes=4).config()
    first = utilization.measure(config, "lite")
    monkeypatch.setattr(utilization, "find_tool", lambda name: Tool(name, (name,), "another version"))
    assert utilization.measure(config, "lite").key != first.key
    assert runs == [1, 1]


BAD_ROWS = [
    "paper",
    "paper/mean",
    "paper/median/4",
    "paper/mean/many",
    "paper/sum/4",
    "paper/mean/4/LFE5U-9F",
]


@pytest.mark.parametrize("text", BAD_ROWS)
def test_a_row_that_is_none(refused, runs, text, tmp_path):
    assert f"--row '{text}' is not PRESET/OPERATOR/LANES" in refused(
        "utilization", "--row", text, "-o", tmp_path
    )


def test_a_later_row_that_is_wrong_stops_before_the_first_is_built(refused, runs, tmp_path):
    rows = ("--row", "lite/mean/4", "--row", "sade/mean/4")
    assert "unknown preset 'sade'" in refused("utilization", *rows, "-o", tmp_path)
    assert runs == []


def test_a_folder_that_is_not_there(refused, runs, tmp_path):
    assert "does not exist" in refused("utilization", "--quick", "-o", tmp_path / "none")
    assert runs == []
