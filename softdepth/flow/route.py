"""Place and route by nextpnr, and what its report says."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softdepth.flow.families import FAMILIES, Part
from softdepth.flow.tools import ToolRunError, find_tool
from softdepth.spec.errors import ConfigError, ToolError

CLOCK_TOLERANCE = 0.01
"""How far a clock that nextpnr reckons from a PLL's settings may be from the intended one."""
PLACED = "placed"
"""The file that a routed design is written to."""

_USED = re.compile(r"^Info:\s+([^:\n]+):\s+(\d+)/\s*(\d+)\s+\d+%", re.MULTILINE)

WORDS = {
    "Total LUT4s": "LUT4",
    "TRELLIS_COMB": "LUT4",
    "ICESTORM_LC": "logic cells",
    "LUT4": "LUT4",
    "Total DFFs": "flip-flops",
    "TRELLIS_FF": "flip-flops",
    "DFF": "flip-flops",
    "DP16KD": "block RAMs",
    "ICESTORM_RAM": "block RAMs",
    "BSRAM": "block RAMs",
    "MULT18X18D": "multipliers",
    "ICESTORM_DSP": "multipliers",
    "MULT18X18": "multipliers",
}
"""nextpnr's words for what a user counts, the most telling first."""


@dataclass(frozen=True)
class Usage:
    """How many of a kind of cell a design takes, and how many the part has."""

    used: int
    available: int


@dataclass(frozen=True)
class CriticalPath:
    """The slowest path of a clock, in nanoseconds: between which cells, through how many steps of logic."""

    start: str
    end: str
    nanoseconds: float
    logic: int

    def __str__(self) -> str:
        return f"{self.start} to {self.end}, {self.nanoseconds:.2f} ns through {self.logic} cells"


@dataclass(frozen=True)
class Clock:
    """A clock: what was asked of it, what it reaches, and what limits it."""

    name: str
    wanted_mhz: float
    fmax_mhz: float
    path: CriticalPath | None

    @property
    def met(self) -> bool:
        """Whether the clock is as fast as was asked."""
        return self.fmax_mhz >= self.wanted_mhz


@dataclass(frozen=True)
class Routed:
    """A design placed and routed.

    Members
    -------
    clocks : every clock with paths of its own; the one with the least to spare comes first.
    usage : nextpnr's own counts, by its own words. ``Total LUT4s`` (ECP5) counts a carry cell as two,
        and the LUTs that a distributed RAM takes.
    seed : what nextpnr's random numbers started from.
    """

    clocks: tuple[Clock, ...]
    usage: dict[str, Usage]
    seed: int

    def check_clock(self, mhz: float) -> None:
        """Raise `ToolError` unless some clock was wanted to be `mhz`: the core's, behind the board's PLL."""
        if not any(abs(clock.wanted_mhz / mhz - 1) < CLOCK_TOLERANCE for clock in self.clocks):
            wanted = ", ".join(f"{clock.name} {clock.wanted_mhz:.2f}" for clock in self.clocks)
            raise ToolError(
                f"nextpnr should have judged a clock of {mhz:.2f} MHz, but judged {wanted or 'none'}",
                "check whether this nextpnr knows the part's PLL; those from PyPI do",
            )

    def check_timing(self) -> None:
        """Raise `TimingError` if a clock is slower than was asked."""
        for clock in self.clocks:
            if not clock.met:
                raise TimingError(clock, self.seed)

    def used(self, word: str) -> int:
        """How many cells nextpnr counts under `word`; 0 where the part has none."""
        return self.usage[word].used if word in self.usage else 0


class TimingError(ToolError):
    """A design that is slower than its clock."""

    def __init__(self, clock: Clock, seed: int) -> None:
        path = f"; the slowest path is from {clock.path}" if clock.path else ""
        super().__init__(
            f"clock {clock.name} reaches {clock.fmax_mhz:.1f} MHz, and {clock.wanted_mhz:.1f} MHz are wanted"
            f" (seed {seed}){path}",
            "try another --seed, or a smaller configuration",
        )


def place_and_route(
    folder: Path, part: Part, *, mhz: float, seed: int = 1, constraints: Path | None = None
) -> Routed:
    """Place and route ``netlist.json`` in `folder` for a part; the result is written to `PLACED` there.

    Parameters
    ----------
    mhz : the clock to aim at, for clocks that the constraints do not name. Missing it is no error here:
        see `Routed.check_timing`.
    constraints : the pin file; without one nextpnr chooses pins (not for Gowin parts).

    Raises `ConfigError` for a design that does not fit the part, naming what is short, and `ToolError`
    where nextpnr is missing or fails.
    """
    pins = None
    if constraints is not None:
        pins = constraints.name
        (folder / pins).write_text(constraints.read_text())
    family = FAMILIES[part.family]
    arguments = [
        *family.place(part, "netlist.json", PLACED, pins),
        *("--freq", f"{mhz:g}", "--seed", str(seed), "--timing-allow-fail"),
        *("--report", "report.json", "--log", "nextpnr.log"),
    ]
    try:
        log = find_tool(family.placer).run(arguments, folder)
    except ToolRunError as failure:
        _check_fits(usage(failure.log), part)
        raise
    counted = usage(log)
    _check_fits(counted, part)
    report = json.loads((folder / "report.json").read_text())
    return Routed(_clocks(report), counted, seed)


def usage(log: str) -> dict[str, Usage]:
    """What nextpnr's log counts."""
    return {match[1].strip(): Usage(int(match[2]), int(match[3])) for match in _USED.finditer(log)}


def _check_fits(counted: dict[str, Usage], part: Part) -> None:
    for word, name in WORDS.items():
        if word in counted and counted[word].used > counted[word].available:
            raise ConfigError(
                f"the design needs {counted[word].used} {name}, and {part.device} has"
                f" {counted[word].available}",
                "use fewer lanes or disparities, a narrower max_width, stored_rows = 0 for less block RAM,"
                " or a larger part",
            )


def _clocks(report: dict[str, Any]) -> tuple[Clock, ...]:
    paths = {p["from"].split()[-1]: p["path"] for p in report["critical_paths"] if p["from"] == p["to"]}
    clocks = [
        Clock(name, entry["constraint"], entry["achieved"], _path(paths.get(name)))
        for name, entry in report["fmax"].items()
    ]
    return tuple(sorted(clocks, key=lambda clock: clock.fmax_mhz / clock.wanted_mhz))


def _path(steps: list[dict[str, Any]] | None) -> CriticalPath | None:
    if not steps:
        return None
    start, end = steps[0]["from"]["cell"], steps[-1]["to"]["cell"]
    logic = sum(step["type"] == "logic" for step in steps)
    return CriticalPath(start, end, sum(step["delay"] for step in steps), logic)
