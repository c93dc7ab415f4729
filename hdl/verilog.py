"""Verilog of a core, for simulators and other people's flows."""

import gc
import re

from amaranth.back import verilog
from amaranth.lib.wiring import Component

from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config

TOP = "softdepth_core"


_CLEARED = re.compile(
    r"^  initial begin\n"
    r"((?:    (\w+)\[\d+\] = (\d+'h0+);\n)(?:    \2\[\d+\] = \3;\n)*)"
    r"  end\n",
    re.MULTILINE,
)


def to_verilog(design: Config | Component, name: str = TOP) -> str:
    """Verilog of the core that a configuration describes, or of any component.

    Ports are ``clk``, ``rst`` (synchronous, active high) and the component's own, nested names
    joined by ``__``: ``i__payload``, ``i__valid``, ``i__ready``, ...
    """
    component = StereoCore(design) if isinstance(design, Config) else design
    # Elaboration makes millions of objects that all live to its end: collecting halves its speed.
    enabled = gc.isenabled()
    gc.disable()
    try:
        text = verilog.convert(component, name=name, emit_src=False)
    finally:
        if enabled:
            gc.enable()
    return _CLEARED.sub(_loop, text)


def _loop(found: re.Match[str]) -> str:
    """A memory cleared by a loop, where Amaranth writes a line for each word: megabytes in deep memories."""
    lines, memory, zero = found.groups()
    words = lines.count("\n")
    return (
        f"  initial begin : clear_{memory}\n"
        f"    integer k;\n"
        f"    for (k = 0; k < {words}; k = k + 1)\n"
        f"      {memory}[k] = {zero};\n"
        f"  end\n"
    )
