"""The package as a LiteX module: LiteX's streams, bus and events around the exported Verilog."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from softdepth.export.streams import streams_of
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import registers
from softdepth.templates import render


def litex_class(name: str) -> str:
    """What the module's class is called: with ``Core`` at its end, so that it is not one of LiteX's own."""
    words = [part[:1].upper() + part[1:] for part in name.split("_")]
    return "".join(words if words[-1] == "Core" else [*words, "Core"])


def litex_module(config: Config, name: str, options: AxiOptions, ports: Sequence[dict[str, Any]]) -> str:
    """The module's source; see `streams_of` for `ports`."""
    last = max(register.address for register in registers(config, options))
    return render(
        "softdepth.export",
        "litex_module.py.jinja",
        name=name,
        config=config,
        version=version("softdepth"),
        bus=options.bus,
        ports=ports,
        streams=streams_of(ports),
        litex_class=litex_class(name),
        size=1 << last.bit_length(),
    )
