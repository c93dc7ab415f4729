"""Board tops: ports as in the pin files, clocks that can be made, LEDs."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.boards import BoardTop
from softdepth.hdl.boards.lamps import BLINKS_PER_SECOND, Lamps
from softdepth.hdl.boards.plls.ecp5 import ecp5_divisors
from softdepth.hdl.boards.plls.gowin import gowin_divisors
from softdepth.hdl.boards.plls.ice40 import ice40_divisors
from softdepth.hdl.boards.top import line_divisor
from softdepth.hdl.verilog import to_verilog
from softdepth.spec.boards import BOARDS, Board
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from tests.support.simulation import simulate
from tests.support.verilog import ports

MHZ = 1_000_000
PINS = re.compile(r'^(?:LOCATE COMP "([^"]+)" SITE|set_io (\S+) |IO_LOC "([^"]+)")', re.MULTILINE)
PLL = {"ecp5": "EHXPLLL", "ice40": "SB_PLL40_PAD", "gowin": "rPLL"}


@pytest.fixture
def config() -> Config:
    return Config.preset("sad").override(["disparities=8", "lanes=1", "max_width=16", "max_height=16"])


def pins(path: Path) -> set[str]:
    """The nets that a constraint file places."""
    return {next(filter(None, match)) for match in PINS.findall(path.read_text())}


@pytest.mark.parametrize("board", [BOARDS[name] for name in ("ulx3s-85f", "icebreaker", "tangnano20k")])
def test_ports_are_the_pins_of_the_constraint_file(project, config, board: Board):
    verilog = to_verilog(BoardTop(board, config), name="top")
    found = set()
    for name, (way, bits) in ports(verilog, "top").items():
        assert way == ("input" if name in ("clk", "rx", "button") else "output")
        found |= {f"{name}[{k}]" for k in range(bits)} if name == "led" else {name}
    assert found == pins(project / "constraints" / board.constraints)
    assert PLL[board.family] in verilog


def test_without_another_clock_there_is_no_pll(config):
    board = replace(BOARDS["ulx3s-85f"], core_hz=25 * MHZ, baud=1 * MHZ)
    assert PLL["ecp5"] not in to_verilog(BoardTop(board, config), name="top")
    assert PLL["ecp5"] not in to_verilog(BoardTop(BOARDS["ulx3s-85f"], config, simulated=True), name="top")


@pytest.mark.parametrize("board", BOARDS.values(), ids=lambda board: board.name)
def test_every_board_has_a_line_that_its_clock_makes(board: Board):
    assert abs(board.core_hz / line_divisor(board) / board.baud - 1) < 0.015


@pytest.mark.parametrize(
    ("make", "oscillator", "core"),
    [
        (ecp5_divisors, 25, 500),
        (ecp5_divisors, 25, 2),
        (ecp5_divisors, 25, 133),
        (ice40_divisors, 12, 300),
        (gowin_divisors, 27, 1),
    ],
)
def test_clocks_that_cannot_be_made_are_refused(make, oscillator, core):
    with pytest.raises(ConfigError, match=f"cannot make {core} MHz from the oscillator's {oscillator} MHz"):
        make(oscillator * MHZ, core * MHZ)


@pytest.mark.parametrize("baud", [20 * MHZ, 3_700_000])
def test_rates_that_the_clock_cannot_make_are_refused(baud):
    with pytest.raises(ConfigError, match=f"50 MHz cannot make {baud} baud"):
        line_divisor(replace(BOARDS["ulx3s-85f"], core_hz=50 * MHZ, baud=baud))


def test_lamps_blink_and_hold_short_events():
    clock = 160
    dut = Lamps(clock)
    alive: list[int] = []
    error: list[int] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for t in range(3 * clock):
            ctx.set(dut.troubled_now, t == clock)
            ctx.set(dut.fault, t >= 2 * clock)
            _, _, *now = await ctx.tick().sample(dut.alive, dut.error)
            alive.append(now[0])
            error.append(now[1])

    simulate(dut, bench)
    edges = sum(a != b for a, b in pairwise(alive))
    assert edges == 2 * 3 * BLINKS_PER_SECOND - 1
    lit = sum(error[clock : 2 * clock])
    assert clock // 8 <= lit <= clock // 4
    assert not any(error[:clock])
    assert all(error[2 * clock :])
