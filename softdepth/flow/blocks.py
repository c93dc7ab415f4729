"""How much of a design each block takes."""

import re
from collections import Counter

from pydantic import BaseModel

from softdepth.flow.synthesis import SCOPE, TOP, Netlist

LUT4 = {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 6}
"""LUT4s that each kind of ECP5 cell takes, as nextpnr counts them: distributed RAM needs two to write."""


class Block(BaseModel):
    """A block and its cells, those of its own sub-blocks included where these are not listed themselves.

    Members
    -------
    name : the path of the block in the core; ``lane`` stands for all lanes together.
    """

    name: str
    lut4: int
    ff: int
    ebr: int
    dsp: int


def blocks(netlist: Netlist, depth: int = 4) -> list[Block]:
    """The blocks of a mapped ECP5 design, by the names that its cells kept from the hierarchy.

    A lookup table belongs to the block whose net it drives; if logic of two blocks was merged, that is
    one of the two.

    Parameters
    ----------
    depth : how many levels below the design's top are told apart.
    """
    cells = netlist["modules"][TOP]["cells"]
    scopes = {name for name, cell in cells.items() if cell["type"] == SCOPE and name.count(".") < depth}
    found: dict[str, Counter[str]] = {}
    for name, cell in cells.items():
        if cell["type"] != SCOPE:
            found.setdefault(_general(_scope(name, scopes)), Counter())[cell["type"]] += 1
    return [
        Block(
            name=name,
            lut4=sum(LUT4[kind] * kinds[kind] for kind in LUT4),
            ff=kinds["TRELLIS_FF"],
            ebr=kinds["DP16KD"],
            dsp=kinds["MULT18X18D"],
        )
        for name, kinds in sorted(found.items())
    ]


def _scope(name: str, scopes: set[str]) -> str:
    """The innermost of `scopes` that a cell lies in; empty for the top."""
    while name and name not in scopes:
        name = name.rpartition(".")[0]
    return name


def _general(scope: str) -> str:
    """A block's name without the numbers of equal instances, and without Amaranth's own suffixes."""
    scope = re.sub(r"\$\d+", "", scope)
    return re.sub(r"_\d+(?=\.|$)", "", scope) or "top"
