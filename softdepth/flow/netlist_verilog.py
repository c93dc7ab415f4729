"""The synthesised netlist of a core as Verilog, to be simulated in place of the gateware's own."""

import copy
import json
import tempfile
from pathlib import Path

from softdepth.flow.netlist import Netlist
from softdepth.flow.synthesis import SCOPE
from softdepth.flow.synthesis import TOP as SYNTHESISED
from softdepth.flow.tools import Tool, find_tool, share_folder
from softdepth.hdl.verilog import TOP
from softdepth.spec.errors import ToolError

YOSYS_MODELS = ("common_sim.vh", "ccu2c_sim.vh")
"""yosys' own models of lookup tables, carry cells, flip-flops and distributed RAM."""

OWN_MODELS = Path(__file__).parent / "models"
"""Models of the cells of which yosys knows only the ports: block RAM and multiplier."""


def netlist_verilog(netlist: Netlist) -> str:
    """Verilog of an ECP5 netlist and of all its cells' models, for `softdepth.sim.frames.run_frames`.

    The models are zero-delay: what is simulated is the function of the netlist, clock by clock.
    Raises `ToolError` for block RAM with initial values, which the model does not have, and where yosys is
    missing or fails.
    """
    yosys = find_tool("yosys")
    with tempfile.TemporaryDirectory(prefix="softdepth-") as name:
        folder = Path(name)
        (folder / "netlist.json").write_text(json.dumps(_for_simulation(netlist)))
        script = (
            f"read_json netlist.json; rename {SYNTHESISED} {TOP}; select {TOP};"
            " write_verilog -noattr -selected netlist.v"
        )
        yosys.run(["-q", "-l", "yosys.log", "-p", script], folder, log="yosys.log")
        text = (folder / "netlist.v").read_text()
    return "\n".join([text, *_models(yosys)])


def _for_simulation(netlist: Netlist) -> Netlist:
    """A copy without what the models lack: names of flattened modules, and initial values that are all 0."""
    found = copy.deepcopy(netlist)
    cells = found["modules"][SYNTHESISED]["cells"]
    for name, cell in list(cells.items()):
        if cell["type"] == SCOPE:
            del cells[name]
            continue
        for key in [key for key in cell["parameters"] if key.startswith("INITVAL_")]:
            if "1" in cell["parameters"].pop(key):
                raise ToolError(
                    f"block RAM {name} has initial values, which its simulation model does not",
                    "keep the memory out of block RAM, or give it no initial values",
                )
    return found


def _models(yosys: Tool) -> list[str]:
    folder = share_folder(yosys) / "lattice"
    try:
        theirs = [(folder / name).read_text() for name in YOSYS_MODELS]
    except OSError as error:
        raise ToolError(
            f"{yosys.version} has no ECP5 models in '{folder}'", "use yosys 0.70 or newer"
        ) from error
    # Without pads, which the core does not have: yosys' file includes them from elsewhere. Its models give
    # delays too, and fill memories in a way that Verilator warns about; neither changes a clocked simulation.
    setting = ["`define NO_INCLUDES", "// verilator lint_off SPECIFYIGN", "// verilator lint_off INITIALDLY"]
    return [*setting, *theirs, *(file.read_text() for file in sorted(OWN_MODELS.glob("*.v")))]
