"""ABC's model checkers, which yosys carries with it: they go much deeper than its own solver.

yosys writes what it read as an and-inverter graph; its pass `abc` then runs a script of ours on that file.
"""

import re
from pathlib import Path
from typing import Literal

from softdepth.flow.tools import find_tool

Answer = Literal["proven", "so far", "refuted"]

GRAPH = (
    "delete -input w:rst; connect -set rst 1'0; setundef -init -zero; simplemap; techmap; opt; dffunmap;"
    " opt_clean; aigmap; opt_clean; setundef -anyseq; write_aiger -I -B -zinit dut.aig"
)
"""From the prepared block on: the reset is over, registers begin as they are said to, and what is undefined
may be anything."""

CARRIER = r"""
module \top
wire input 1 \a
wire output 2 \b
wire \t
cell $_NOT_ \n
connect \A \a
connect \Y \t
end
connect \b \t
end
"""
BACK = ".model netlist\n.inputs ys__n1\n.outputs ys__n0\n.names ys__n1 ys__n0\n0 1\n.end\n"
"""The pass wants a netlist to map, and its result: an inverter."""

STATUS = re.compile(r"snl_(SAT|UNSAT|UNK)\s+(-?\d+)")


def asked(prepared: str, folder: Path, checker: str, clocks: int = 0) -> Answer:
    """What `checker`, a command of ABC with commas for spaces, finds of the assertions in a prepared block.

    `prepared` is the script that prepares it. Fails where the checker gave up before it had looked at so many
    clocks.
    """
    answer, last = _said(prepared, folder, f"scorr;{checker}")
    if answer == "UNK" and not clocks and last == 0:
        # Merging equal signals can leave the checker nothing to look at. It is then given the whole block.
        answer, last = _said(prepared, folder, checker)
    if answer == "SAT":
        return "refuted"
    if answer == "UNSAT":
        return "proven"
    assert 0 < clocks <= last + 1, f"{checker} looked at {last + 1} of {clocks} clocks"
    return "so far"


def _said(prepared: str, folder: Path, commands: str) -> tuple[str, int]:
    """ABC's status after the commands, and how many clocks it looked at, less 1."""
    (folder / "carrier.il").write_text(CARRIER)
    (folder / "back.blif").write_text(BACK)
    (folder / "status").unlink(missing_ok=True)
    commands = f"read_aiger,dut.aig;fold;orpos;strash;{commands};write_status,status;read_blif,back.blif"
    script = f"{prepared} {GRAPH}; design -reset; read_rtlil carrier.il; abc -script +{commands}"
    find_tool("yosys").run(["-q", "-l", "log", "-p", script], folder, log="log")
    said = (folder / "status").read_text()
    found = STATUS.search(said)
    assert found, f"{commands} says '{said}'"
    return found[1], int(found[2])
