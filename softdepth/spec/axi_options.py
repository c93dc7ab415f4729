"""How the core with AXI streams is built, beyond its configuration."""

from dataclasses import dataclass
from typing import Literal

from softdepth.spec.bus import Bus

Inputs = Literal["one", "two"]
Clocks = Literal["one", "own"]
SKEW_LINES = 2
"""Lines that one of two streams may be ahead by default."""


@dataclass(frozen=True)
class AxiOptions:
    """Ports of the core, which do not affect any result.

    Members
    -------
    bus : how the registers are reached.
    inputs : one stream of both views' pixels, or two, each of one view's.
    skew : of two streams, lines by which one may be ahead of the other without having to wait.
    clocks : two streams are synchronous to the core's clock, or each has its own.
    left : results carry their pixel of the left view.
    """

    bus: Bus = "axi-lite"
    inputs: Inputs = "one"
    skew: int = SKEW_LINES
    clocks: Clocks = "one"
    left: bool = False

    @property
    def two(self) -> bool:
        """The views come in two streams."""
        return self.inputs == "two"


DEFAULT = AxiOptions()
"""One stream in, no pixels out, AXI4-Lite."""
