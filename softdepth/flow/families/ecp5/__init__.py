"""Lattice's ECP5, with four netlist passes that yosys lacks."""

import re

from softdepth.flow.families.ecp5.copies import copy_registers
from softdepth.flow.families.ecp5.fuse import fuse_carries
from softdepth.flow.families.ecp5.multiplier_registers import absorb_multiplier_registers
from softdepth.flow.families.ecp5.ram_registers import absorb_ram_registers
from softdepth.flow.families.family import Family, Part

PATIENCE = ["--placer-heap-cell-placement-timeout", "0"]
"""No limit to the attempts at placing a cell. nextpnr's own follows from the square of the number of cells,
which overflows from some 50,000 on: then it gives up after 10,000, in designs that fill half the part."""


class Ecp5(Family):
    """ECP5 by yosys, nextpnr-ecp5 and Trellis; the device's name gives its size (``LFE5U-85F``: 85)."""

    placer = "nextpnr-ecp5"
    packer = "ecppack"
    suffix = ".bit"
    passes = (fuse_carries, absorb_ram_registers, absorb_multiplier_registers, copy_registers)

    def synthesis(self, top: str) -> str:
        return f"synth_ecp5 -top {top}"

    def place(self, part: Part, netlist: str, placed: str, constraints: str | None) -> list[str]:
        size = re.fullmatch(r"LFE5U-(\d+)F", part.device)
        assert size, f"no ECP5 is called {part.device}"
        pins = ["--lpf", constraints] if constraints else ["--lpf-allow-unconstrained"]
        device = [f"--{size[1]}k", "--package", part.package, "--speed", part.speed]
        return [*device, *pins, *PATIENCE, "--json", netlist, "--textcfg", placed]

    def pack(self, part: Part, placed: str, bitstream: str) -> list[str]:
        return ["--compress", "--input", placed, "--bit", bitstream]
