"""The AXI streams among a core's ports: one description for all that the package says of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

CLOCK = "aclk"
"""The core's clock; a stream's own has its prefix before it."""
SIGNALS = ("tdata", "tvalid", "tready", "tuser", "tlast")


@dataclass(frozen=True)
class Stream:
    """An AXI stream.

    Members
    -------
    prefix : how its ports' names begin.
    sink : it comes in.
    bits : of ``tdata``.
    clock : the port that it is synchronous to.
    """

    prefix: str
    sink: bool
    bits: int
    clock: str

    @property
    def own_clock(self) -> str | None:
        """Its clock, if that is not the core's."""
        return self.clock if self.clock != CLOCK else None

    @property
    def ports(self) -> dict[str, str]:
        """Its ports by what AXI calls them."""
        return {signal: f"{self.prefix}_{signal}" for signal in SIGNALS}


def streams_of(ports: Sequence[dict[str, Any]]) -> list[Stream]:
    """The streams among a core's ports, each with its name, direction (``in``, ``out``) and width."""
    names = {port["name"] for port in ports}
    found = []
    for port in ports:
        if port["name"].endswith("_tdata"):
            prefix = port["name"].removesuffix("_tdata")
            own = f"{prefix}_{CLOCK}"
            clock = own if own in names else CLOCK
            found.append(Stream(prefix, port["direction"] == "in", port["width"], clock))
    return found
