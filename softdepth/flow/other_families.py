"""Families that cores are only mapped to, not placed: how much of a part a netlist takes."""

import json
import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from softdepth.flow.families import FAMILIES, part_of
from softdepth.flow.synthesis import JOIN, SCOPE, TOP
from softdepth.flow.tools import find_tool
from softdepth.spec.boards import BOARDS, Board
from softdepth.spec.errors import ToolError


@dataclass(frozen=True)
class Taken:
    """Look-up tables, flip-flops, block RAMs and multipliers, of the kinds that the family has."""

    lut: int = 0
    ff: int = 0
    ram: int = 0
    dsp: int = 0

    def __add__(self, other: "Taken") -> "Taken":
        return Taken(self.lut + other.lut, self.ff + other.ff, self.ram + other.ram, self.dsp + other.dsp)

    def times(self, count: int) -> "Taken":
        """What this many of the same take."""
        return Taken(self.lut * count, self.ff * count, self.ram * count, self.dsp * count)


@dataclass(frozen=True)
class OtherFamily:
    """A family of parts.

    Members
    -------
    title : as its vendor calls it.
    command : yosys' synthesis of a design called `TOP`.
    lut, ram, dsp : what the vendor calls a look-up table, a block RAM and a multiplier.
    ram_kbit : bits of a block RAM, parity included.
    cells : what a cell takes, by a pattern of its whole name. Dedicated wiring takes nothing.
    """

    title: str
    command: str
    lut: str
    ram: str
    dsp: str
    ram_kbit: int
    cells: Mapping[str, Taken]

    def taken(self, cells: Mapping[str, int]) -> Taken:
        """What a netlist takes; raises `ToolError` for a cell that the family does not have."""
        total = Taken()
        for kind, count in cells.items():
            total += self._of(kind).times(count)
        return total

    def _of(self, kind: str) -> Taken:
        for pattern, each in self.cells.items():
            if re.fullmatch(pattern, kind):
                return each
        raise ToolError(
            f"yosys has mapped to {kind}, which {self.title} is not known to have", "please report this"
        )


def _command_of(board: Board) -> str:
    """The command that synthesises for a board's part."""
    family = FAMILIES[board.family]
    return " ".join((family.synthesis(TOP), *family.synthesis_options(part_of(board))))


_LUT, _FF, _RAM, _DSP, _WIRING = Taken(lut=1), Taken(ff=1), Taken(ram=1), Taken(dsp=1), Taken()

OTHER_FAMILIES = {
    "7-series": OtherFamily(
        title="AMD 7-series",
        command=f"synth_xilinx -top {TOP} -family xc7 -noiopad -noclkbuf",
        lut="LUT6",
        ram="RAMB18",
        dsp="DSP48E1",
        ram_kbit=18,
        cells={
            "LUT[1-6]|INV|SRL16E|SRLC16E|SRLC32E": _LUT,
            "RAM(32|64)X1D": _LUT.times(2),
            "RAM32M|RAM64M|RAM128X1D": _LUT.times(4),
            "FD[RSCP]E(_1)?": _FF,
            "RAMB18E1": _RAM,
            "RAMB36E1": _RAM.times(2),
            "DSP48E1": _DSP,
            "CARRY4|MUXF[78]": _WIRING,
        },
    ),
    "gowin": OtherFamily(
        title="Gowin GW2A",
        command=_command_of(BOARDS["tangnano20k"]),
        lut="LUT4",
        ram="BSRAM",
        dsp="MULT18X18",
        ram_kbit=18,
        cells={
            "LUT[1-4]|ALU": _LUT,
            "RAM16SDP[124]": _LUT.times(4),
            "DFFN?[SRCP]?E?": _FF,
            "(SP|SDPB?|DPB?|pROM)(X9B?)?": _RAM,
            "MULT(9X9|18X18)": _DSP,
            "MULT36X36": _DSP.times(4),
            "MUX2_LUT[5-8]|GND|VCC": _WIRING,
        },
    ),
    "nexus": OtherFamily(
        title="Lattice Nexus",
        command=f"synth_nexus -top {TOP} -family lifcl",
        lut="LUT4",
        ram="EBR",
        dsp="MULT18X18",
        ram_kbit=18,
        cells={
            "LUT4|INV": _LUT,
            "CCU2|WIDEFN9": _LUT.times(2),
            "DPR16X4": _LUT.times(4),
            "FD1P3[BDIJ]X": _FF,
            "(DP|PDP|PDPSC)16K": _RAM,
            "MULT(9X9|18X18)": _DSP,
            "MULT18X36": _DSP.times(2),
            "MULT36X36": _DSP.times(4),
            "VHI|VLO|IB|OBZ?|BB": _WIRING,
        },
    ),
}
"""By the name that a row has. Carry cells of Gowin and Nexus lie in look-up tables, AMD's beside them."""


def synthesised(rtlil: str, family: OtherFamily) -> dict[str, int]:
    """Cells by type of RTLIL whose top module is called `TOP`; raises `ToolError` if yosys fails."""
    with tempfile.TemporaryDirectory(prefix="softdepth-") as name:
        folder = Path(name)
        (folder / "design.il").write_text(rtlil)
        script = f"read_rtlil design.il; {family.command}; {JOIN}; tee -q -o cells.json stat -json"
        find_tool("yosys").run(["-q", "-l", "yosys.log", "-p", script], folder, log="yosys.log")
        found = json.loads((folder / "cells.json").read_text())["design"]["num_cells_by_type"]
    return {kind: count for kind, count in found.items() if kind != SCOPE}
