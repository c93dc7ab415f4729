"""How many rows of a window are remembered: what a configuration accepts, and what follows from it."""

import re
from pathlib import Path
from typing import Any

import pytest

from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.spec.config import PRESETS, Config
from softdepth.spec.errors import ConfigError
from tests.support.simulation import config, sad


@pytest.mark.parametrize(
    ("keys", "most"),
    [
        ({"cost": "sum", "criteria": [sad(3)]}, 2),
        ({"criteria": [sad(3), sad(5), sad(7)]}, 6),
        ({"criteria": [sad(1), sad(9, 2), sad(3)]}, 8),
    ],
)
def test_from_none_to_all_rows_above_the_newest(keys: dict[str, Any], most: int) -> None:
    for stored in range(most + 1):
        c = config(disparities=4, lanes=2, stored_rows=stored, **keys)
        assert c.column_rows == most + 1 - stored
    with pytest.raises(ConfigError) as refusal:
        config(disparities=4, lanes=2, stored_rows=most + 1, **keys)
    text = str(refusal.value)
    for part in (f"stored_rows is {most + 1}", f"a window of {most + 1} rows", f"{most} above its newest"):
        assert part in text
    assert "use at most that many" in text


@pytest.mark.parametrize("value", [-1, 1.5, "two", None])
def test_other_values_are_refused_by_name(value: Any) -> None:
    with pytest.raises(ConfigError, match=r"^stored_rows = .* is not valid"):
        config(stored_rows=value)


def test_presets_keep_their_rows_within_their_windows() -> None:
    for name in PRESETS:
        c = Config.preset(name)
        assert 0 <= c.stored_rows <= 2 * c.reach_rows
        assert c.override(["stored_rows=0"]).column_rows == c.min_height


def test_a_window_that_shrinks_takes_its_rows_along() -> None:
    """The error comes where the two meet, whichever was changed last."""
    c = Config.preset("sad").override(["criteria.0.window=7", "stored_rows=6"])
    with pytest.raises(ConfigError, match="stored_rows is 6, but a window of 5 rows"):
        c.override(["criteria.0.window=5"])


def test_said_beside_the_criteria_it_is_the_highest_windows() -> None:
    beside = config(disparities=4, lanes=2, criteria=[sad(3), sad(7), sad(5)], stored_rows=4)
    own = config(disparities=4, lanes=2, criteria=[sad(3), sad(7) | {"stored_rows": 4}, sad(5)])
    assert beside == own
    assert own.override(["stored_rows=1"]).criteria[1].model_dump()["stored_rows"] == 1
    assert own.override(["criteria.1.stored_rows=2", "criteria.2.stored_rows=3"]).stored_rows == 3
    with pytest.raises(ConfigError, match=r"criteria\.0: stored_rows is 3, but a window of 3 rows"):
        config(criteria=[sad(3) | {"stored_rows": 3}, sad(5), sad(7)])


def test_it_shapes_the_core_and_is_kept_in_files(tmp_path: Path) -> None:
    c = Config.preset("sad").override(["stored_rows=1"])
    assert c.hash != c.override(["stored_rows=0"]).hash != c.override(["stored_rows=2"]).hash
    c.save(tmp_path / "core.toml")
    assert Config.load(tmp_path / "core.toml").stored_rows == 1


@pytest.mark.parametrize("steps", [1, 2, 8])
def test_places_of_a_line(steps: int) -> None:
    c = config(disparities=8, lanes=8 // steps, max_width=23)
    assert c.places == 23 * steps


@pytest.mark.parametrize("stored", [0, 3, 6])
def test_the_line_buffer_holds_the_computed_rows_only(stored: int) -> None:
    """What lanes remember, the line buffer need not: its memory is as wide as all rows but the newest."""
    c = config(disparities=4, lanes=2, stored_rows=stored)
    text = to_rtlil(StereoCore(c), "core")
    lines = re.search(r"^module \\core\.costs\S*\.lines\n", text, re.MULTILINE)
    assert lines, "it is looked for in the wrong place"
    slices = re.findall(r"^module \\core\.costs\S*\.lines\.lines\n.*?^end$", text, re.DOTALL | re.MULTILINE)
    words = re.findall(r"^  memory width (\d+) size (\d+)", "".join(slices), re.MULTILINE)
    assert sum(int(bits) for bits, _ in words) == 2 * c.pixel.size * (6 - stored)
