"""How a core meets the design around it, where that has AXI streams."""

from dataclasses import dataclass
from typing import Literal

Bus = Literal["axi-lite", "wishbone"]
BUSES: tuple[Bus, ...] = ("axi-lite", "wishbone")


@dataclass(frozen=True)
class Edge:
    """What can be chosen of the outside of a core, and changes no result.

    Members
    -------
    bus : of the registers.
    separate : the views come as two streams, which are joined here.
    skew : with that, by how many lines one view may be ahead of the other.
    """

    bus: Bus = "axi-lite"
    separate: bool = False
    skew: int = 1
