"""FPGA parts: what the tools call them, and how to tell the tools."""

import re
from dataclasses import dataclass

from softdepth.spec.boards import Board, Family

_ICE40 = {"iCE40UP5K": "--up5k"}
_GOWIN = {"GW2AR-LV18": "GW2A-18C"}

PLACER = {"ecp5": "nextpnr-ecp5", "ice40": "nextpnr-ice40", "gowin": "nextpnr-himbaechel"}
PACKER = {"ecp5": "ecppack", "ice40": "icepack", "gowin": "gowin_pack"}


@dataclass(frozen=True)
class Part:
    """An FPGA as it is sold: ``Part("ecp5", "LFE5U-85F", "CABGA381", "6")``."""

    family: Family
    device: str
    package: str
    speed: str

    @classmethod
    def of(cls, board: Board) -> "Part":
        """The part on a board."""
        return cls(board.family, board.device, board.package, board.speed)

    @property
    def suffix(self) -> str:
        """The usual name of its bitstreams' files."""
        return {"ecp5": ".bit", "ice40": ".bin", "gowin": ".fs"}[self.family]

    @property
    def synthesis_options(self) -> tuple[str, ...]:
        """What yosys' synthesis command is told besides the family."""
        return ("-device", "u", "-dsp") if self.device == "iCE40UP5K" else ()

    def place(self, netlist: str, placed: str, constraints: str | None) -> list[str]:
        """nextpnr's arguments for this part: the files to read, and the one to write."""
        match self.family:
            case "ecp5":
                size = re.fullmatch(r"LFE5U-(\d+)F", self.device)
                assert size, f"no ECP5 is called {self.device}"
                pins = ["--lpf", constraints] if constraints else ["--lpf-allow-unconstrained"]
                device = [f"--{size[1]}k", "--package", self.package, "--speed", self.speed]
                return [*device, *pins, "--json", netlist, "--textcfg", placed]
            case "ice40":
                pins = ["--pcf", constraints] if constraints else []
                device = [_ICE40[self.device], "--package", self.package.lower()]
                return [*device, *pins, "--json", netlist, "--asc", placed]
            case "gowin":
                pins = ["--vopt", f"cst={constraints}"] if constraints else []
                device = ["--device", self.device, "--vopt", f"family={self._gowin_family}"]
                return [*device, *pins, "--json", netlist, "--write", placed]

    def pack(self, placed: str, bitstream: str) -> list[str]:
        """The packing program's arguments."""
        match self.family:
            case "ecp5":
                return ["--compress", "--input", placed, "--bit", bitstream]
            case "ice40":
                return [placed, bitstream]
            case "gowin":
                return ["-d", self._gowin_family, "-o", bitstream, placed]

    @property
    def _gowin_family(self) -> str:
        return next(family for start, family in _GOWIN.items() if self.device.startswith(start))
