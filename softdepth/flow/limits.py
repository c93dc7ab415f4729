"""Stored limits of area: what small cores may take, so that a change that costs area is noticed.

``python -m softdepth.flow.limits`` synthesises them all and prints what they take beside the limits.
"""

import tomllib
from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, Field

from softdepth.flow.blocks import LUT4
from softdepth.flow.synthesis import Netlist, cells, core_netlist
from softdepth.spec.config import Config

FILE = Path(__file__).with_suffix(".toml")


class Limit(BaseModel):
    """A core, and the most of each resource that it may take; ``set`` in the file is `changes`."""

    name: str
    preset: str
    changes: list[str] = Field(alias="set")
    lut4: int
    ff: int
    ebr: int

    @property
    def config(self) -> Config:
        """The core's configuration."""
        return Config.preset(self.preset).override(self.changes)

    def exceeded(self, taken: Mapping[str, int]) -> list[str]:
        """A line for each resource of which more is `taken` than allowed, with both numbers."""
        allowed = {"lut4": self.lut4, "ff": self.ff, "ebr": self.ebr}
        return [
            f"{self.name}: {taken[resource]} {resource}, and the limit is {most}"
            for resource, most in allowed.items()
            if taken[resource] > most
        ]


def load_limits(file: Path = FILE) -> list[Limit]:
    """Every limit of a file."""
    data = tomllib.loads(file.read_text())
    return [Limit.model_validate({"name": name, **entry}) for name, entry in data.items()]


def taken(netlist: Netlist) -> dict[str, int]:
    """What a mapped ECP5 design takes, counted as nextpnr does before packing."""
    found = cells(netlist)
    return {
        "lut4": sum(count * found[kind] for kind, count in LUT4.items()),
        "ff": found["TRELLIS_FF"],
        "ebr": found["DP16KD"],
    }


def main() -> None:
    """Print, for each core, what it takes and what it may."""
    for limit in load_limits():
        now = taken(core_netlist(limit.config))
        shown = (f"{key} {value} of {getattr(limit, key)}" for key, value in now.items())
        print(f"{limit.name}: {', '.join(shown)}", flush=True)


if __name__ == "__main__":
    main()
