"""Registers of the arithmetic are called after what they hold, so that a timing report can be read."""

import re

import pytest

from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.spec.config import Config
from softdepth.spec.presets import PRESETS

NAMELESS = re.compile(r"(value|word|result|late)(_late_\d+)?(\$\d+)?")
"""What says nothing: a result is one among words, and everything in a pipeline is late."""

NO_NAME = "$signal"
"""What Amaranth calls a signal that it found no name for, such as the first of two in one assignment."""


def registers(rtlil: str, room: str = r"\w+") -> set[str]:
    """The names of all registers in a room of the core, or in all of them."""
    found: set[str] = set()
    for module in rtlil.split("\nmodule ")[1:]:
        if re.match(rf"\\core\.{room}\b", module):
            cells = re.findall(r"^  cell \$a?s?dffe? .*?^  end$", module, re.DOTALL | re.MULTILINE)
            found.update(name for cell in cells for name in re.findall(r"connect \\Q \\([^\s\[]+)", cell))
    return found


@pytest.mark.parametrize("preset", ["paper", "compact", "lite", "robust"])
def test_registers_are_named(preset: str) -> None:
    small = {"disparities": 4, "lanes": 2}
    text = to_rtlil(StereoCore(Config.from_dict({**PRESETS[preset], **small})), "core")
    assert not [name for name in registers(text) if name.startswith(NO_NAME)]
    for room in ("costs", "winners"):
        names = registers(text, room)
        assert len(names) > 5, f"{room}: they are looked for in the wrong place"
        assert not sorted(filter(NAMELESS.fullmatch, names))


def test_names_that_say_nothing_are_found() -> None:
    text = to_rtlil(StereoCore(Config.from_dict({**PRESETS["lite"], "disparities": 4, "lanes": 2})), "core")
    broken = text.replace("\\a_top", "\\result")
    assert broken != text
    assert "result" in filter(NAMELESS.fullmatch, registers(broken, "costs"))
