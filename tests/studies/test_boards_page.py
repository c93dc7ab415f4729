"""The table of the boards' own cores: what it is made of, and that the one in the documents is of today's."""

from pathlib import Path

import pytest

from softdepth.flow.bitstream import MANIFEST, Manifest
from softdepth.spec.boards import BOARDS, Board
from softdepth.spec.errors import InputError
from softdepth.studies import boards_page

USAGE = {
    "ecp5": {"Total LUT4s": 9000, "Total DFFs": 20000, "DP16KD": 30, "MULT18X18D": 20},
    "ice40": {"ICESTORM_LC": 5000, "ICESTORM_RAM": 29},
    "gowin": {"LUT4": 7000, "DFF": 9000, "BSRAM": 12, "MULT18X18": 20},
}


def manifest(board: Board) -> Manifest:
    """What a build of the board's own core might leave."""
    return Manifest(
        key="0",
        board=board.name,
        device=board.device,
        bitstream=f"softdepth-{board.name}.bit",
        made="2026-01-01T00:00:00+00:00",
        config=board.config.model_dump(mode="json"),
        config_hash=board.config.hash,
        softdepth="0.1.0",
        revision=None,
        tools={},
        seed=1,
        clock="clk",
        wanted_mhz=board.core_hz / 1e6,
        fmax_mhz=77.7,
        critical_path="a to b",
        usage={word: {"used": n, "available": 99_999} for word, n in USAGE[board.family].items()},
        seconds={},
    )


@pytest.fixture
def builds(tmp_path: Path) -> Path:
    """A folder with the manifest of every board."""
    for board in BOARDS.values():
        folder = tmp_path / "out" / board.name
        folder.mkdir(parents=True)
        (folder / MANIFEST).write_text(manifest(board).model_dump_json())
    return tmp_path / "out"


def test_each_board_has_a_row_of_its_figures(builds, tmp_path):
    document = tmp_path / "docs" / "flow.md"
    document.parent.mkdir()
    document.write_text("before\n<!-- boards:begin -->\nold\n<!-- boards:end -->\nafter\n")
    boards_page.main(builds, tmp_path)
    text = document.read_text()
    assert text.startswith("before\n<!-- boards:begin -->\n| board |")
    assert text.endswith("|\n<!-- boards:end -->\nafter\n")
    rows = {row.split("`")[1]: row for row in text.splitlines() if row.startswith("| `")}
    assert list(rows) == list(BOARDS)
    assert "| 9,000 of 99,999 | - | 20,000 of 99,999 | 30 of 99,999 | 20 of 99,999 |" in rows["ulx3s-85f"]
    assert "| - | 5,000 of 99,999 | - | 29 of 99,999 | - | 18.0 | 77.7 | 0.6 |" in rows["icebreaker"]
    assert "| 7,000 of 99,999 | - | 9,000 of 99,999 | 12 of 99,999 | 20 of 99,999 |" in rows["tangnano20k"]


def test_a_board_that_was_not_built_is_named(builds):
    (builds / "icebreaker" / MANIFEST).unlink()
    with pytest.raises(InputError, match="run: make bitstream BOARD=icebreaker"):
        boards_page.measured(builds)


def test_a_board_that_was_not_built_keeps_its_row(builds, tmp_path):
    document = tmp_path / "docs" / "flow.md"
    document.parent.mkdir()
    document.write_text("<!-- boards:begin -->\n<!-- boards:end -->\n")
    boards_page.main(builds, tmp_path)
    before = document.read_text()
    again = manifest(BOARDS["icebreaker"]).model_copy(update={"fmax_mhz": 88.8})
    (builds / "icebreaker" / MANIFEST).write_text(again.model_dump_json())
    (builds / "tangnano20k" / MANIFEST).unlink()
    boards_page.main(builds, tmp_path)
    assert document.read_text() == before.replace("18.0 | 77.7", "18.0 | 88.8")
    figures = tmp_path / "docs" / "boards.json"
    figures.write_text(figures.read_text().replace('"lanes": 4,', '"lanes": 2,'))
    with pytest.raises(InputError, match="run: make bitstream BOARD=tangnano20k"):
        boards_page.main(builds, tmp_path)


def test_the_build_of_another_core_is_refused(builds):
    board = BOARDS["ulx3s-12f"]
    other = manifest(board).model_copy(update={"config_hash": "0123456789ab"})
    (builds / board.name / MANIFEST).write_text(other.model_dump_json())
    with pytest.raises(InputError, match="is not for the ulx3s-12f's default core"):
        boards_page.measured(builds)


def test_the_documents_table_is_of_the_boards_own_cores(project):
    """Its figures are measured by `make boards`; which cores they are of is known."""
    rows = boards_page.load(project)
    assert list(rows) == list(BOARDS)
    text = (project / "docs" / "flow.md").read_text()
    assert f"<!-- boards:begin -->\n{boards_page.page(rows.values())}\n<!-- boards:end -->" in text
