"""Lattice's iCE40: small parts; the UltraPlus ones have multipliers."""

from typing import NamedTuple

from softdepth.flow.families.family import Family, Part


class _Device(NamedTuple):
    place: str
    synthesis: tuple[str, ...] = ()


DEVICES = {"iCE40UP5K": _Device("--up5k", ("-device", "u", "-dsp"))}
"""Each part's name for nextpnr, and its options for yosys."""


class Ice40(Family):
    """iCE40 by yosys, nextpnr-ice40 and icestorm."""

    placer = "nextpnr-ice40"
    packer = "icepack"
    suffix = ".bin"

    def synthesis(self, top: str) -> str:
        return f"synth_ice40 -top {top}"

    def synthesis_options(self, part: Part) -> tuple[str, ...]:
        return DEVICES[part.device].synthesis

    def place(self, part: Part, netlist: str, placed: str, constraints: str | None) -> list[str]:
        pins = ["--pcf", constraints] if constraints else []
        device = [DEVICES[part.device].place, "--package", part.package.lower()]
        return [*device, *pins, "--json", netlist, "--asc", placed]

    def pack(self, part: Part, placed: str, bitstream: str) -> list[str]:
        return [placed, bitstream]
