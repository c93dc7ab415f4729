"""Verilog of a core, for simulators and other people's flows."""

import gc

from amaranth.back import verilog
from amaranth.lib.wiring import Component

from softdepth.config import Config
from softdepth.hdl.core import StereoCore

TOP = "softdepth_core"


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
        return verilog.convert(component, name=name, emit_src=False)
    finally:
        if enabled:
            gc.enable()
