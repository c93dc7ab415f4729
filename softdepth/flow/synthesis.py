"""Amaranth gateware into a netlist of a part's cells, by yosys."""

import json
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from amaranth.lib.wiring import Component

from softdepth.flow.families import FAMILIES, NetlistPass
from softdepth.flow.netlist import Netlist
from softdepth.flow.tools import find_tool
from softdepth.hdl.text.collisions import waive_collisions
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.hdl.text.share import share
from softdepth.spec.config import Config

TOP = "top"
"""The name of every synthesised design."""

SCOPE = "$scopeinfo"
"""A cell that is none: yosys leaves one of the name of each module that it flattened."""

JOIN = "setattr -mod -unset keep_hierarchy; flatten; opt_merge; opt_clean"
"""Lanes were kept apart so that each was mapped once; from here on the design is one module."""


def to_shared_rtlil(design: Component) -> str:
    """RTLIL of a component called `TOP`, with equal modules once."""
    return share(waive_collisions(to_rtlil(design, TOP)))


def synthesise(
    design: Component | str,
    family: str,
    folder: Path,
    *,
    options: Sequence[str] = (),
    passes: Sequence[NetlistPass] | None = None,
) -> Netlist:
    """Synthesise a design and return its netlist, which is also written to ``netlist.json``.

    Parameters
    ----------
    design : a component, or RTLIL with a top module called `TOP`.
    folder : gets the files of the run.
    options : for yosys' synthesis command, e.g. ``-nobram``.
    passes : done to the netlist; by default those of the family.

    Raises `ToolError` if yosys is missing or fails.
    """
    text = design if isinstance(design, str) else to_shared_rtlil(design)
    (folder / "design.il").write_text(text)
    target = FAMILIES[family]
    command = " ".join((target.synthesis(TOP), *options))
    script = f"read_rtlil design.il; {command}; {JOIN}; {target.pads} write_json mapped.json"
    # The packaged yosys may lose what it prints, but not what it logs.
    find_tool("yosys").run(["-q", "-l", "yosys.log", "-p", script], folder, log="yosys.log")
    netlist = json.loads((folder / "mapped.json").read_text())
    for each in target.passes if passes is None else passes:
        each(netlist)
    (folder / "netlist.json").write_text(json.dumps(netlist))
    return netlist


def core_netlist(config: Config, *, passes: Sequence[NetlistPass] | None = None) -> Netlist:
    """The ECP5 netlist of a core alone, after all passes; raises as `synthesise` does."""
    from softdepth.hdl.core import StereoCore  # elaboration is slow to import

    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        return synthesise(StereoCore(config), "ecp5", Path(folder), passes=passes)


def cells(netlist: Netlist) -> Counter[str]:
    """How many cells of each type the design has."""
    types = (cell["type"] for cell in netlist["modules"][TOP]["cells"].values())
    return Counter(kind for kind in types if kind != SCOPE)
