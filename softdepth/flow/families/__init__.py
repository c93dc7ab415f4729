"""The families of FPGAs that bitstreams are built for, one module each.

Another part of a family is a line in its module; another family is a module here and its PLL in
`softdepth.hdl.boards.plls`.
"""

from softdepth.flow.families.ecp5 import Ecp5
from softdepth.flow.families.family import Family, NetlistPass, Part
from softdepth.flow.families.gowin import Gowin
from softdepth.flow.families.ice40 import Ice40
from softdepth.spec.boards import Board

FAMILIES: dict[str, Family] = {"ecp5": Ecp5(), "ice40": Ice40(), "gowin": Gowin()}
"""Every family by the name that a board gives it."""

__all__ = ["FAMILIES", "Family", "NetlistPass", "Part", "part_of"]


def part_of(board: Board) -> Part:
    """The part on a board."""
    return Part(board.family, board.device, board.package, board.speed)
