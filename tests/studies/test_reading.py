"""The table of exported cores that yosys reads."""

import pytest

from softdepth.spec.config import Config
from softdepth.spec.errors import InputError, ToolError
from softdepth.studies import reading

SMALL = {"lanes": 2, "disparities": 4, "max_width": 16, "max_height": 16}


def test_a_row_for_each_preset(tmp_path, monkeypatch):
    small = Config.preset("sad").override([f"{key}={value}" for key, value in SMALL.items()])
    monkeypatch.setattr(reading, "built_presets", lambda: ["sad"])
    monkeypatch.setattr(reading.Config, "preset", lambda name: small)
    (tmp_path / "docs").mkdir()
    page = tmp_path / "docs" / "flow.md"
    page.write_text("before\n<!-- reading:begin -->\nold\n<!-- reading:end -->\nafter\n")
    reading.main(tmp_path)
    text = page.read_text()
    assert "| `sad`, 4 disparities, lanes = 2, 16 wide |" in text
    assert "old" not in text
    assert text.startswith("before\n")
    assert text.endswith("after\n")


def test_elsewhere_than_in_the_project(tmp_path):
    with pytest.raises(InputError, match="project's folder"):
        reading.main(tmp_path)


def test_what_yosys_cannot_read_is_an_error():
    with pytest.raises(ToolError, match="yosys cannot read"):
        reading.read("module softdepth_core(; endmodule", "proc")
