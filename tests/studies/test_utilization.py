"""Rows of the table of area and speed: what they hold, how they follow from nextpnr, when they are made."""

import json
import shutil
from types import SimpleNamespace

import pytest
from amaranth.sim import Simulator

from softdepth.cli.app import main
from softdepth.flow.blocks import blocks
from softdepth.flow.families import ecp5
from softdepth.flow.limits import taken
from softdepth.flow.measuring_top import MeasuringTop
from softdepth.flow.route import Clock, CriticalPath, Routed, Usage
from softdepth.flow.synthesis import TOP, synthesise
from softdepth.flow.tools import Tool
from softdepth.spec.config import Config
from softdepth.studies import other_families, utilization, utilization_page
from softdepth.studies.utilization import PART, Row, Selection, row_of

KEYS = (
    "device preset operator disparities lanes width lut4 ff ebr dsp fmax_mhz"
    " cycles_per_pixel mpixel_s mde_s mde_s_per_klut lut4_per_lane"
)

PATH = CriticalPath("core.a", "core.b", 8.0, 5)


def routed(fmax: float = 125.0, luts: int = 8000) -> Routed:
    counts = {"Total LUT4s": luts, "Total DFFs": 9000, "DP16KD": 12, "MULT18X18D": 34}
    usage = {word: Usage(count, 83640) for word, count in counts.items()}
    return Routed((Clock("clk", 150.0, fmax, PATH),), usage, 1)


class Runs(list[int]):
    """The seeds of the runs of nextpnr, and what stands for the gateware."""

    gateware = "as it is"


def row(fmax: float = 125.0, luts: int = 8000, lanes: int = 16) -> Row:
    config = Selection(preset="paper", operator="mean", lanes=lanes).config()
    return row_of(config, "paper", PART, routed(fmax, luts))


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


@pytest.mark.parametrize(
    ("fmax", "lanes", "modes"),
    [
        (125.0, 16, ["VGA 60", "720p30"]),
        (110.7, 32, ["VGA 60", "720p30", "720p60"]),
        (110.5, 32, ["VGA 60", "720p30"]),
        (60.0, 4, []),
    ],
)
def test_video_modes(fmax, lanes, modes):
    assert utilization_page.modes(row(fmax, lanes=lanes)) == modes


def test_the_recommended_rows_are_sound_configurations():
    for selection in utilization_page.RECOMMENDED:
        config = selection.config()
        assert (config.disparities, config.max_width) == (64, selection.width or 1280)
    assert set(utilization_page.QUICK) < set(utilization_page.RECOMMENDED)
    presets = {(s.preset, s.lanes) for s in utilization_page.RECOMMENDED if s.operator == "mean"}
    assert presets >= {(p, n) for p in ("paper", "compact", "lite", "sad") for n in (8, 32)}


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


@pytest.fixture
def runs(cache, monkeypatch):
    """Measurements that take no time: the netlists that were placed and routed, with their seeds.

    ``runs.gateware`` is what synthesis makes of every configuration.
    """
    done = Runs()

    def synthesise(design, family, folder, *, options):
        (folder / "netlist.json").write_text(f"{done.gateware} {design.config.hash}")
        return {"modules": {TOP: {"cells": {}}}}

    def place_and_route(folder, part, *, mhz, seed):
        done.append(seed)
        return routed()

    monkeypatch.setattr(
        utilization,
        "MeasuringTop",
        lambda config: SimpleNamespace(config=config, lut4=75, flip_flops=205),
    )
    monkeypatch.setattr(utilization, "synthesise", synthesise)
    monkeypatch.setattr(utilization, "place_and_route", place_and_route)
    return done


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


def test_other_options_of_nextpnr_measure_again(runs, tmp_path, monkeypatch):
    """Neither figures nor a median are of two kinds of runs."""
    row = ("--row", "sad/sum/8@1", "--row", "sad/sum/8@2", "-o", str(tmp_path))
    assert main(["utilization", *row]) == 0
    before = utilization_page.load(tmp_path)
    monkeypatch.setattr(ecp5, "PATIENCE", ["--placer-heap-cell-placement-timeout", "9"])
    assert main(["utilization", *row[:2], *row[4:]]) == 0
    (after,) = utilization_page.load(tmp_path)
    assert after.key not in {each.key for each in before}
    assert {each.but_for_seed for each in before} == {before[0].but_for_seed} != {after.but_for_seed}
    assert runs == [1, 2, 1]


def test_rows_whose_speed_is_promised_have_three_seeds():
    seeds = {each.preset: utilization_page.seeds_of(each, 1) for each in utilization_page.RECOMMENDED}
    assert seeds["robust"] == seeds["robust-small"] == (1, 2, 3)
    assert seeds["paper"] == (1,)


def test_what_the_page_holds_is_not_measured_again(runs, cache, tmp_path):
    """On a machine whose cache is empty, too; a row of changed gateware is measured anew."""
    rows = ("--row", "paper/mean/4", "--row", "sad/mean/8")
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    written = (tmp_path / "utilization.json").read_bytes()
    assert len(runs) == 2
    shutil.rmtree(cache)
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    assert len(runs) == 2
    assert (tmp_path / "utilization.json").read_bytes() == written
    runs.gateware = "changed"
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    assert len(runs) == 4


@pytest.mark.parametrize("text", ["", "{}", '{"rows": [1], "runs": []}', '{"rows": [{}], "runs": [{}]}'])
def test_a_page_of_another_form_is_measured_anew(runs, tmp_path, text):
    (tmp_path / "utilization.json").write_text(text)
    assert main(["utilization", "--row", "sad/mean/8", "-o", str(tmp_path)]) == 0
    assert len(runs) == 1


def test_the_command_writes_both_files(runs, tmp_path, capfd):
    rows = ("--row", "paper/mean/4", "--row", "sad/mean/8")
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    data = json.loads((tmp_path / "utilization.json").read_text())
    assert [(r["preset"], r["lanes"]) for r in data["rows"]] == [("paper", 4), ("sad", 8)]
    assert all(" ".join(r) == KEYS for r in data["rows"])
    assert data["runs"][0]["seed"] == 1
    page = (tmp_path / "utilization.md").read_text()
    assert "| paper | mean | LFE5U-85F-6 | 64 | 4 | 1280 | 8,000 | 9,000 | 12 | 196 | 34 | 125.0 |" in page
    assert "| 125.0 | 16 | 7.8 | 500 | 62 | 2000 | 1: 125.0 |" in page
    assert "core.a to core.b, 8.00 ns through 5 cells" in page
    assert "row 2 of 2: sad/sum/8" in capfd.readouterr().err


def test_one_row_again_leaves_the_others(runs, tmp_path):
    rows = ("--row", "paper/mean/4", "--row", "sad/mean/8")
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    before = json.loads((tmp_path / "utilization.json").read_text())
    runs.gateware = "changed"
    assert main(["utilization", "--row", "paper/mean/4", "-o", str(tmp_path)]) == 0
    data = json.loads((tmp_path / "utilization.json").read_text())
    assert data["rows"] == before["rows"]
    assert data["runs"][0]["key"] != before["runs"][0]["key"]
    assert data["runs"][1] == before["runs"][1]
    assert main(["utilization", "--row", "paper/mean/4", "--disparities", "32", "-o", str(tmp_path)]) == 0
    data = json.loads((tmp_path / "utilization.json").read_text())
    assert [row["disparities"] for row in data["rows"]] == [64, 64, 32]


def test_the_headline_is_the_median_of_the_seeds(runs, tmp_path, monkeypatch):
    """Seeds stay side by side while the netlist is the same; a clock is never the best of them."""
    clocks = {1: 113.0, 2: 99.0, 3: 101.0, 4: 90.0}
    monkeypatch.setattr(utilization, "place_and_route", lambda *_, seed, **__: routed(clocks[seed]))
    rows = [word for seed in (1, 2, 3) for word in ("--row", f"sad/sum/8@{seed}")]
    assert main(["utilization", *rows, "-o", str(tmp_path)]) == 0
    ((headline, seeds),) = utilization_page.medians(utilization_page.load(tmp_path))
    assert headline.row.fmax_mhz == 101.0
    assert [each.row.fmax_mhz for each in seeds] == [113.0, 99.0, 101.0]
    assert "1: 113.0, 2: 99.0, 3: 101.0" in (tmp_path / "utilization.md").read_text()
    assert main(["utilization", "--row", "sad/sum/8@4", "-o", str(tmp_path)]) == 0
    ((headline, seeds),) = utilization_page.medians(utilization_page.load(tmp_path))
    assert (headline.row.fmax_mhz, len(seeds)) == (99.0, 4)


def test_a_row_for_another_part(runs, tmp_path):
    assert main(["utilization", "--row", "robust-small/sum/16/LFE5U-45F", "-o", str(tmp_path)]) == 0
    (found,) = utilization_page.load(tmp_path)
    assert (found.row.device, found.row.operator) == ("LFE5U-45F-6", "sum")
    assert utilization_page.block_rams_left(found.row) == 108 - 12
    assert "| robust-small/sum/16/LFE5U-45F |" in (tmp_path / "utilization.md").read_text()


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


def test_the_page_in_the_documents_is_what_its_figures_give(project):
    figures = json.loads((project / "docs" / "utilization.json").read_text())
    families = other_families.load(project / "docs")
    page = utilization_page.page(utilization_page.load(project / "docs"), figures["tools"], families)
    assert page == (project / "docs" / "utilization.md").read_text()


def test_programs_of_earlier_rows_stay_named(runs, tmp_path, monkeypatch):
    """Rows that stay were measured by those, whatever is installed now."""
    for seed, version in enumerate(("one", "another", "another"), 1):
        found = Tool("any", ("any",), version)
        monkeypatch.setattr(utilization_page, "find_tool", lambda name, found=found: found)
        assert main(["utilization", "--row", f"sad/sum/8@{seed}", "-o", str(tmp_path)]) == 0
    assert json.loads((tmp_path / "utilization.json").read_text())["tools"]["yosys"] == "one or another"
