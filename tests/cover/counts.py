"""Which lines and toggles of a core's Verilog the quick regression reaches, by Verilator's counts.

Lines are those of the Verilog as Amaranth means it, module by module: blocks, their branches, and ways past
these. Toggles are those of the simplified netlist, without bits that are constants, and memories.
"""

import json
import re
import tempfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.sim.build import TOP
from softdepth.sim.trials import Coverage, Trial, run_trials
from softdepth.spec.config import Config
from tests.mutation.netlist import SIMPLIFIED, room_of, yosys_of_faults
from tests.mutation.regression import regression

TEXTS = {
    "line": f"read_rtlil core.il; hierarchy -top {TOP}; proc -nomux -norom; memory_collect",
    "toggle": f"{SIMPLIFIED}; opt_clean -purge; write_json core.json",
}
"""What makes the Verilog of which each kind is counted."""

OWN = "dump_module$"
"""Of lines that yosys adds so that a simulator looks at a block once: not the core's."""
MADE = re.compile(
    r"^\s*(?:if \(.*\) )?(?P<name>[\\\w$][^\s\[]*)\s*(?:\[[^=]*\]\s*)?(?P<how><?=) (?P<value>[^;]*?)\s*;"
)
"""An assignment."""
NUMBERED = re.compile(r"\$\d+")
"""What Amaranth adds to a name that is there twice."""


@dataclass(frozen=True)
class Point:
    """A branch of a block, or a bit that changes both ways.

    Members
    -------
    kind : ``line`` or ``toggle``.
    block : the instances that it is in, as ``front.guard``; empty in the core itself.
    what : a line's signal and the branch, a toggle's signal and bit.
    """

    kind: str
    block: str
    what: str

    @property
    def room(self) -> str:
        """Of the core's rooms, the one that it is in; empty in none."""
        return room_of(self.block)


@dataclass(frozen=True)
class Found:
    """A point, and whether it was reached."""

    point: Point
    reached: bool


def reached(config: Config, *, thorough: bool = True) -> list[Found]:
    """What the regression reaches of a core, of both kinds; fails where the core does not pass it."""
    trials = regression(config, thorough=thorough)
    found = []
    for kind, script in TEXTS.items():
        with tempfile.TemporaryDirectory(prefix="softdepth-cover-") as name:
            folder = Path(name)
            (folder / "core.il").write_text(to_rtlil(StereoCore(config), TOP))
            script = f"{script}; write_verilog core.v"
            yosys_of_faults().run(["-q", "-l", "log", "-p", script], folder, log="log")
            constant = _constant(folder / "core.json") if kind == "toggle" else set()
            found += counted(kind, (folder / "core.v").read_text(), trials, constant)
    return found


def counted(
    kind: str, verilog: str, trials: Sequence[Trial], constant: Collection[str] = frozenset()
) -> list[Found]:
    """What trials reach of a text without the bits that are `constant`; fails where it does not pass them."""
    with tempfile.TemporaryDirectory(prefix="softdepth-cover-") as name:
        data = Path(name) / "coverage.dat"
        (verdict,) = run_trials(verilog, trials, coverage=Coverage(kind, data))
        assert verdict.trial is None, verdict
        records = list(_records(data.read_text()))
    return _lines(verilog, records) if kind == "line" else _toggles(records, constant)


def _constant(netlist: Path) -> set[str]:
    """The bits of signals that nothing drives, or a constant."""
    module = json.loads(netlist.read_text())["modules"][TOP]
    driven = {bit for port in module["ports"].values() for bit in port["bits"]}
    for cell in module["cells"].values():
        for name, bits in cell["connections"].items():
            if cell["port_directions"][name] == "output":
                driven.update(bits)
    return {
        f"{name}[{k}]" if len(net["bits"]) > 1 else name
        for name, net in module["netnames"].items()
        for k, bit in enumerate(net["bits"])
        if isinstance(bit, str) or bit not in driven
    }


def _records(data: str) -> Iterator[tuple[dict[str, str], int]]:
    """Verilator's file: of each point its keys and values, between control characters, and its count."""
    for line in data.splitlines():
        if line.startswith("C '"):
            keys, _, count = line[3:].rpartition("' ")
            yield dict(part.split("\x02", 1) for part in keys.split("\x01") if "\x02" in part), int(count)


def _lines(verilog: str, records: list[tuple[dict[str, str], int]]) -> list[Found]:
    lines = verilog.splitlines()
    signals = _signals(lines)
    found = []
    for fields, count in records:
        number = int(fields["l"]) - 1
        if OWN not in lines[number]:
            block = NUMBERED.sub(
                "", fields["h"].removeprefix("TOP").removeprefix(f".{TOP}").removeprefix(".")
            )
            branch = lines[number].replace("\\", "").strip()
            what = f"{signals[number]}: {fields['o']} of {branch}"
            found.append(Found(Point("line", block, what), count > 0))
    return found


def _signals(lines: list[str]) -> list[str]:
    """Of each line the signal that the block around it makes, a register by its own name."""
    registers: dict[str, str] = {}
    signals, name = [], ""
    for number, line in enumerate(lines):
        if line.startswith("module"):
            registers, name = {}, ""
        if line.lstrip().startswith("always"):
            made = next(filter(None, map(MADE.match, islice(lines, number, None))))
            if made["how"] == "<=":
                registers[made["value"]] = made["name"]
            name = registers.get(made["name"], made["name"])
        signals.append(name.removeprefix("\\"))
    return signals


def _toggles(records: list[tuple[dict[str, str], int]], constant: Collection[str]) -> list[Found]:
    """A bit is reached if it rises and falls."""
    bits: dict[str, bool] = {}
    for fields, count in records:
        name = _plain(fields["o"]).rpartition(":")[0]
        bits[name] = bits.get(name, True) and count > 0
    found = []
    for name in sorted(bits.keys() - constant):
        path, *bit = re.split(r"(?=\[)", name)
        if len(bit) < 2:  # Verilator counts no memories but the smallest
            block, _, signal = NUMBERED.sub("", path).rpartition(".")
            found.append(Found(Point("toggle", block, "".join([signal, *bit])), bits[name]))
    return found


def _plain(name: str) -> str:
    """A name without the codes that Verilator writes for other signs than letters and digits."""
    return re.sub(r"__0([0-9A-Fa-f]{2})", lambda sign: chr(int(sign[1], 16)), name)
