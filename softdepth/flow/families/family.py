"""What the flow must know of a family of FPGAs, and the parts of one."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from softdepth.flow.netlist import Netlist

NetlistPass = Callable[[Netlist], int]
"""Changes a netlist in place and returns how many cells went."""


@dataclass(frozen=True)
class Part:
    """An FPGA as it is sold: ``Part("ecp5", "LFE5U-85F", "CABGA381", "6")``.

    Members
    -------
    family : its name in `softdepth.flow.families.FAMILIES`.
    device, package, speed : as the vendor writes them; ``speed`` is empty where there is one grade only.
    """

    family: str
    device: str
    package: str
    speed: str


class Family(ABC):
    """Tools, options and netlist passes for the parts of one family.

    Members
    -------
    placer, packer : names of the place-and-route program and of the one that packs its result.
    suffix : the usual name of a bitstream's file.
    pads : yosys commands that give the flattened top its input and output buffers, or nothing.
    passes : what is done to each netlist between yosys and nextpnr, in this order.
    """

    placer: str
    packer: str
    suffix: str
    pads: str = ""
    passes: tuple[NetlistPass, ...] = ()

    @abstractmethod
    def synthesis(self, top: str) -> str:
        """yosys' synthesis command for a top module, whatever the part."""

    def synthesis_options(self, part: Part) -> tuple[str, ...]:
        """What the synthesis command is told of a part besides."""
        return ()

    @abstractmethod
    def place(self, part: Part, netlist: str, placed: str, constraints: str | None) -> list[str]:
        """nextpnr's arguments: the part, the files to read, and the one to write."""

    @abstractmethod
    def pack(self, part: Part, placed: str, bitstream: str) -> list[str]:
        """The packing program's arguments."""
