"""Faults in a core's netlist, all in one text: an input selects one of them, or none.

yosys' pass `mutate` puts them in, after the core was flattened and simplified: a bit at a cell's port is
stuck, inverted, or turned by another bit of the same port.
"""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softdepth.flow.tools import Tool, find_tool
from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.rtlil import CLOCK, to_rtlil
from softdepth.sim.build import TOP
from softdepth.sim.trials import FAULTS
from softdepth.spec.config import Config

SELECT_BITS = 16
SPARE = 3
"""Faults that are drawn for each that is wanted: some are none, and are left out."""

SIMPLIFIED = (
    f"read_rtlil core.il; hierarchy -top {TOP}; proc; flatten;"
    # yosys' pass for flip-flops stumbles over wires that others have joined: these are tidied up first.
    " opt_merge; opt_clean; opt_dff; opt_clean;"
    " opt -full; wreduce; opt_clean -purge; memory_collect"
)
PREPARED = f"{SIMPLIFIED}; splitcells; opt_clean -purge"
"""Bits that nothing sees are gone then: a fault in them would be none."""

ROOMS = ("front", "costs", "winners")
MODES = {
    "const0": "stuck at 0",
    "const1": "stuck at 1",
    "inv": "inverted",
    "cnot0": "inverted where bit {ctrlbit} is 0",
    "cnot1": "inverted where bit {ctrlbit} is 1",
}


def room_of(block: str) -> str:
    """Of the core's rooms, the one that a block is in; empty in none."""
    first = block.partition(".")[0]
    return first if first in ROOMS or not first else "post"


@dataclass(frozen=True)
class Mutant:
    """One fault.

    Members
    -------
    number : the value that selects it.
    block : the instances that the cell is in, as ``front.guard``; empty where yosys made it of several.
    file, code : the file of the gateware, or of its library, that made the cell, and the line; or empty.
    what : the cell, its port and bit, the signal and bit that this is where it has a name, and what is wrong.
    """

    number: int
    block: str
    file: str
    code: str
    what: str

    @property
    def room(self) -> str:
        """Of the core's rooms, the one that it is in."""
        return room_of(self.block)

    def __str__(self) -> str:
        return f"{self.block or 'merged'}: {self.code or '(several lines)'}: {self.what}"


def yosys_of_faults() -> Tool:
    """The yosys that draws faults: the locked one, as each version draws others."""
    return find_tool("yosys", own=False)


def mutants(config: Config, count: int, folder: Path, seed: int = 1) -> tuple[str, list[Mutant]]:
    """Verilog of the core with `count` faults to choose from, and what they are.

    `folder` takes yosys' files. Left out are faults that change nothing by their very place: of a bit that
    nothing reads, of a constant at its own value, of a bit turned by a constant, or by one that alone settles
    what the cell says; and those of clocks.
    """
    (folder / "core.il").write_text(to_rtlil(StereoCore(config), TOP, sources=True))
    yosys = yosys_of_faults()
    drawn = f"mutate -list {SPARE * count} -seed {seed} -ctrl {FAULTS} {SELECT_BITS} 1 -o drawn"
    script = f"{PREPARED}; write_rtlil flat.il; write_json flat.json; {drawn}"
    yosys.run(["-q", "-l", "log", "-p", script], folder, log="log")
    module = json.loads((folder / "flat.json").read_text())["modules"][TOP]
    read, made = _read(module), _made(module)
    chosen, found = [], []
    for command in (folder / "drawn").read_text().splitlines():
        words = command.split()
        number, options = int(words[4]), dict(zip(words[5::2], words[6::2], strict=True))
        cell = module["cells"][options["-cell"].removeprefix("\\")]
        if len(found) < count and changes(cell, options, read):
            chosen.append(command)
            sources = [place for flag, place in zip(words[5::2], words[6::2], strict=True) if flag == "-src"]
            sources = sources or [made[bit] for bit in _written(cell) if bit in made]
            found.append(_described(number, options, cell["type"].lstrip("$"), sources))
    (folder / "chosen").write_text("\n".join(chosen) + "\n")
    script = "read_rtlil flat.il; script chosen; opt_clean; write_verilog -noattr core.v"
    yosys.run(["-q", "-l", "log", "-p", script], folder, log="log")
    return (folder / "core.v").read_text(), found


def _read(module: dict[str, Any]) -> set[Any]:
    """The bits that a cell or an output reads."""
    ports = [port["bits"] for port in module["ports"].values() if port["direction"] == "output"]
    for cell in module["cells"].values():
        ways = cell["port_directions"]
        ports += [bits for name, bits in cell["connections"].items() if ways[name] == "input"]
    return {bit for bits in ports for bit in bits}


def _written(cell: dict[str, Any]) -> list[Any]:
    """The bits that a cell drives."""
    ways = cell["port_directions"]
    return [bit for name, bits in cell["connections"].items() if ways[name] == "output" for bit in bits]


def _made(module: dict[str, Any]) -> dict[Any, str]:
    """Of each bit, the line of a cell that reads it: where yosys made its driver itself, this tells most."""
    found: dict[Any, str] = {}
    for cell in module["cells"].values():
        source = cell["attributes"].get("src", "").partition("|")[0]
        for name, bits in cell["connections"].items() if source else ():
            if cell["port_directions"][name] == "input":
                found.update((bit, source) for bit in bits if bit not in found)
    return found


def changes(cell: dict[str, Any], options: dict[str, str], read: set[Any]) -> bool:
    """Whether a fault at a cell's port can be one, of a cell whose bits are numbers or constants as text.

    `options` are those of yosys' pass; `read` are the bits that something reads.
    """
    port, mode = options["-port"], options["-mode"]
    bits = cell["connections"][port]
    bit = bits[int(options["-portbit"])]
    if port == CLOCK.upper() or bit == "x" or bit not in read:
        return False
    if mode.startswith("cnot"):
        control = int(options["-ctrlbit"])
        return isinstance(bits[control], int) and not _settled(cell, port, control, mode[-1])
    return not (mode.startswith("const") and bit == mode[-1])


def _settled(cell: dict[str, Any], port: str, bit: int, value: str) -> bool:
    """Whether a cell's output is known where a bit of its input is `value`, whatever the others are."""
    match cell["type"]:
        case "$reduce_or" | "$reduce_bool" | "$logic_not":
            return value == "1"
        case "$reduce_and":
            return value == "0"
        case "$eq" | "$ne":
            other = cell["connections"]["B" if port == "A" else "A"]
            return (other[bit] if bit < len(other) else "0") == ("1" if value == "0" else "0")
    return False


def _described(number: int, options: dict[str, str], kind: str, sources: list[str]) -> Mutant:
    mode = MODES[options["-mode"]].format(ctrlbit=options.get("-ctrlbit", ""))
    wire = options.get("-wire", "")
    # The signal is what a fault is known by: bits of ports are numbered anew where yosys splits cells.
    leaf = wire.removeprefix("\\").split(".")[-1].removeprefix("\\")
    signal = f" ({leaf}[{options['-wirebit']}])" if leaf else ""
    # Amaranth numbers names that are there twice, yosys puts a backslash before each.
    path = options["-cell"].removeprefix("$flatten").replace("\\", "")
    block = ".".join((path if path != options["-cell"] else wire).split(".")[:-1])
    place = {"file": "", "code": ""}
    if sources:
        file, line = sources[0].rsplit(":", 1)
        own = re.search(r"\bhdl/.*", file)
        code = Path(file).read_text().splitlines()[int(line) - 1].strip()
        place = {"file": own[0] if own else Path(file).name, "code": code}
    return Mutant(
        number,
        block=re.sub(r"\$\d+", "", block),
        what=f"{kind} {options['-port']}[{options['-portbit']}]{signal} {mode}",
        **place,
    )
