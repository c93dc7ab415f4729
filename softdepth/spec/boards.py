"""The boards that a bitstream can be built for: what part is on them, and what core fits it.

Pins are in ``constraints/``, the top in `softdepth.hdl.boards`; the build is `softdepth.flow`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError

Family = Literal["ecp5", "ice40", "gowin"]

GOWIN_DIES = {"GW2AR-LV18": "GW2A-18C"}
"""The die of each Gowin part, by how the part's name starts: another part is a line."""


@dataclass(frozen=True)
class Board:
    """A board with an FPGA, a serial port and an oscillator.

    Members
    -------
    name : what ``--board`` takes.
    family : decides which synthesis, place-and-route and packing tools build for it.
    device, package, speed : the part, as its vendor writes it (``LFE5U-85F``, ``CABGA381``, ``6``).
    clock_hz : the oscillator's frequency.
    constraints : its pin file, in ``constraints/``.
    preset, overrides : the core that is built by default, ``key=value`` as `Config.override` takes them.
    core_hz : the clock that a PLL makes for the core from the oscillator's.
    baud : bits per second of the serial port; ``core_hz`` is a multiple of it.
    program : the command that loads a bitstream; ``{bitstream}`` stands for the file.
    """

    name: str
    family: Family
    device: str
    package: str
    speed: str
    clock_hz: int
    constraints: str
    preset: str
    overrides: tuple[str, ...]
    core_hz: int
    baud: int
    program: tuple[str, ...]

    @property
    def config(self) -> Config:
        """The configuration that is built for this board unless another is asked for."""
        return Config.preset(self.preset).override(self.overrides)


def find_board(name: str) -> Board:
    """The board called `name`; raises `ConfigError` for an unknown one."""
    if name not in BOARDS:
        raise ConfigError(f"unknown board '{name}'", f"use one of {', '.join(BOARDS)}")
    return BOARDS[name]


def gowin_die(device: str) -> str:
    """What the tools call the die of a Gowin part; raises `ConfigError` for an unknown one."""
    for start, die in GOWIN_DIES.items():
        if device.startswith(start):
            return die
    raise ConfigError(f"unknown Gowin part '{device}'", f"use one of {', '.join(GOWIN_DIES)}")


def _ulx3s(size: int, preset: str, *overrides: str) -> Board:
    return Board(
        name=f"ulx3s-{size}f",
        family="ecp5",
        device=f"LFE5U-{size}F",
        package="CABGA381",
        speed="6",
        clock_hz=25_000_000,
        constraints="ulx3s.lpf",
        preset=preset,
        overrides=overrides,
        core_hz=50_000_000,
        baud=2_000_000,
        program=("openFPGALoader", "--board", "ulx3s", "{bitstream}"),
    )


def _boards() -> Iterator[Board]:
    yield _ulx3s(12, "robust-small", "lanes=16", "max_width=640")
    yield _ulx3s(25, "robust-small", "lanes=16", "max_width=640")
    yield _ulx3s(45, "robust-small", "lanes=16", "max_width=1280")
    yield _ulx3s(85, "robust", "lanes=16", "max_width=1280")
    yield Board(
        name="icebreaker",
        family="ice40",
        device="iCE40UP5K",
        package="SG48",
        speed="",
        clock_hz=12_000_000,
        constraints="icebreaker.pcf",
        preset="sad",
        overrides=("disparities=32", "lanes=1", "max_width=320", "stored_rows=0"),
        core_hz=18_000_000,
        baud=2_000_000,
        program=("openFPGALoader", "--board", "ice40_generic", "{bitstream}"),  # into its flash: no other way
    )
    yield Board(
        name="tangnano20k",
        family="gowin",
        device="GW2AR-LV18QN88C8/I7",
        package="QN88",
        speed="C8/I7",
        clock_hz=27_000_000,
        constraints="tangnano20k.cst",
        preset="lite",
        overrides=("lanes=4", "max_width=640", "stored_rows=0"),
        core_hz=54_000_000,
        baud=2_000_000,
        program=("openFPGALoader", "--board", "tangnano20k", "{bitstream}"),
    )


BOARDS: dict[str, Board] = {board.name: board for board in _boards()}
"""Every board by its name."""
