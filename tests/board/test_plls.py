"""The PLLs' settings against those that the families' own tools reckon."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from softdepth.hdl.boards.plls.divisors import MHZ, Divisors
from softdepth.hdl.boards.plls.ecp5 import ecp5_divisors
from softdepth.hdl.boards.plls.gowin import gowin_divisors
from softdepth.hdl.boards.plls.ice40 import FILTERS, ice40_divisors


def said(tool: str, *arguments: object) -> str:
    """What a tool of the environment prints; it must succeed."""
    program = Path(sys.executable).parent / tool
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


def number(text: str, pattern: str) -> float:
    found = re.search(pattern, text)
    assert found, text
    return float(found[1])


@pytest.mark.slow
@pytest.mark.parametrize("core", [50, 62.5, 75, 87.5, 100, 125])
def test_ecp5(tmp_path, core):
    """Its tool takes another VCO where several do: the ratio is the same, and ours is in the VCO's range."""
    text = said("yowasp-ecppll", "-i", 25, "-o", core, "-f", tmp_path / "pll.v")
    assert number(text, r"clkout0 frequency: ([\d.]+)") == core
    found = ecp5_divisors(25 * MHZ, round(core * MHZ))
    assert found.reference == number(text, r"Refclk divisor: (\d+)")
    assert found.feedback == number(text, r"Feedback divisor: (\d+)")
    assert 400 <= core * found.output <= 800


@pytest.mark.slow
@pytest.mark.parametrize("core", [18, 24, 30, 48, 60])
def test_ice40(core):
    text = said("yowasp-icepll", "-i", 12, "-o", core)
    found = ice40_divisors(12 * MHZ, core * MHZ)
    reference, feedback, output = (number(text, rf"{name}:\s+(\d+) ") for name in ("DIVR", "DIVF", "DIVQ"))
    assert found == Divisors(reference + 1, feedback + 1, 2**output)
    filter_range = next(value for limit, value in FILTERS if 12 / found.reference < limit)
    assert filter_range == number(text, r"FILTER_RANGE: (\d)")


@pytest.mark.slow
@pytest.mark.parametrize("core", [27, 54, 81, 108])
def test_gowin(core):
    text = said("gowin_pll", "-i", 27, "-o", core, "-d", "GW2AR-18 C8/I7")
    assert number(text, r"Achieved output frequency:\s+([\d.]+)") == core
    found = gowin_divisors(27 * MHZ, core * MHZ)
    assert found.reference - 1 == number(text, r"IDIV_SEL\((\d+)\)")
    assert found.feedback - 1 == number(text, r"FBDIV_SEL\((\d+)\)")
    low, high = number(text, r"VCO = .*range: (\d+)-"), number(text, r"VCO = .*range: \d+-(\d+)")
    assert low <= core * found.output <= high
