"""Rows of other families: when yosys runs, and what is written."""

import shutil
from pathlib import Path

import pytest

from softdepth.cli.app import main
from softdepth.flow.other_families import OTHER_FAMILIES
from softdepth.studies import other_families, utilization_page
from softdepth.studies.utilization import Selection

CELLS = {
    "synth_xilinx": {"LUT2": 1000, "FDRE": 20, "RAMB18E1": 3, "DSP48E1": 4},
    "synth_gowin": {"ALU": 2000, "DFFE": 30, "DPB": 5, "MULT18X18": 6},
    "synth_nexus": {"CCU2": 3000, "FD1P3IX": 40, "PDPSC16K": 7, "MULT18X18": 8},
}
ROWS = (Selection(preset="lite", operator="mean", lanes=4),)


@pytest.fixture
def runs(cache: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Syntheses that take no time: the families' commands, as they ran."""
    done: list[str] = []

    def synthesised(text, target):
        done.append(target.command.split()[0])
        return CELLS[done[-1]]

    monkeypatch.setattr(other_families, "synthesised", synthesised)
    monkeypatch.setattr(other_families, "to_shared_rtlil", lambda core: core.hash)
    monkeypatch.setattr(other_families, "StereoCore", lambda config: config)
    return done


def test_each_family_has_its_figures(runs: list[str]) -> None:
    found = other_families.measure_all(ROWS)
    assert runs == list(CELLS)
    assert [row.family for row in found] == list(OTHER_FAMILIES)
    figures = [(row.lut, row.ff, row.ram, row.dsp) for row in found]
    assert figures == [(1000, 20, 3, 4), (2000, 30, 5, 6), (6000, 40, 7, 8)]
    assert {(row.preset, row.operator, row.disparities, row.lanes, row.width) for row in found} == {
        ("lite", "mean", 64, 4, 1280)
    }


def test_what_is_known_is_not_synthesised_again(runs: list[str], cache: Path, tmp_path: Path) -> None:
    """From the cache, or where that is empty from the figures that were written; other cores are."""
    found = other_families.measure_all(ROWS)
    assert other_families.measure_all(ROWS) == found
    assert len(runs) == 3
    shutil.rmtree(cache)
    other_families.write(tmp_path, found)
    known = other_families.load(tmp_path)
    assert other_families.measure_all(ROWS, known=known) == found
    assert len(runs) == 3
    other_families.measure_all(ROWS, known=known, disparities=32)
    assert len(runs) == 6


@pytest.mark.parametrize("text", ["", "{}", '{"rows": [1]}', '{"rows": [{}]}'])
def test_figures_of_another_form_are_none(tmp_path: Path, text: str) -> None:
    (tmp_path / other_families.JSON).write_text(text)
    assert other_families.load(tmp_path) == []


def test_the_command_renews_the_page(runs: list[str], project: Path, tmp_path: Path, monkeypatch) -> None:
    """The ECP5's rows stay as they are."""
    monkeypatch.setattr(other_families, "ROWS", ROWS)
    shutil.copy(project / "docs" / utilization_page.JSON, tmp_path)
    assert main(["utilization", "--families", "-o", str(tmp_path)]) == 0
    page = (tmp_path / "utilization.md").read_text()
    assert "| lite | mean | AMD 7-series | 64 | 4 | 1280 | 1,000 | 20 | 3 | 4 |" in page
    assert "| lite | mean | Lattice Nexus | 64 | 4 | 1280 | 6,000 | 40 | 7 | 8 |" in page
    before = (project / "docs" / "utilization.md").read_text()
    table = "## Video"
    assert page.partition(table)[0].count("\n|") == before.partition(table)[0].count("\n|")


def test_families_with_rows(refused, runs: list[str], tmp_path: Path) -> None:
    assert "--families measures other rows" in refused("utilization", "--families", "--quick", "-o", tmp_path)
    assert runs == []


def test_families_without_a_page(refused, runs: list[str], tmp_path: Path) -> None:
    assert "has no utilization.json" in refused("utilization", "--families", "-o", tmp_path)
    assert runs == []
