"""The page of area and speed and its figures: which rows are on it, which stay, and what is shown of them."""

import json
import shutil

import pytest

from softdepth.cli.app import main
from softdepth.flow.families import ecp5
from softdepth.flow.tools import Tool
from softdepth.studies import other_families, utilization, utilization_page
from tests.studies.rows import KEYS, routed, row


def test_the_recommended_rows_are_sound_configurations():
    for selection in utilization_page.RECOMMENDED:
        config = selection.config()
        assert (config.disparities, config.max_width) == (64, selection.width or 1280)
    assert set(utilization_page.QUICK) < set(utilization_page.RECOMMENDED)
    presets = {(s.preset, s.lanes) for s in utilization_page.RECOMMENDED if s.operator == "mean"}
    assert presets >= {(p, n) for p in ("paper", "compact", "lite", "sad") for n in (8, 32)}


def test_rows_whose_speed_is_promised_have_three_seeds():
    seeds = {each.preset: utilization_page.seeds_of(each, 1) for each in utilization_page.RECOMMENDED}
    assert seeds["robust"] == seeds["robust-small"] == (1, 2, 3)
    assert seeds["paper"] == (1,)


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


def test_programs_of_earlier_rows_stay_named(runs, tmp_path, monkeypatch):
    """Rows that stay were measured by those, whatever is installed now."""
    for seed, version in enumerate(("one", "another", "another"), 1):
        found = Tool("any", ("any",), version)
        monkeypatch.setattr(utilization_page, "find_tool", lambda name, found=found: found)
        assert main(["utilization", "--row", f"sad/sum/8@{seed}", "-o", str(tmp_path)]) == 0
    assert json.loads((tmp_path / "utilization.json").read_text())["tools"]["yosys"] == "one or another"


def test_the_page_in_the_documents_is_what_its_figures_give(project):
    figures = json.loads((project / "docs" / "utilization.json").read_text())
    families = other_families.load(project / "docs")
    page = utilization_page.page(utilization_page.load(project / "docs"), figures["tools"], families)
    assert page == (project / "docs" / "utilization.md").read_text()
