"""The core with AXI streams as a package: everything that a design needs to use it."""

import tempfile
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from peakrdl_cheader.exporter import CHeaderExporter
from peakrdl_markdown import MarkdownExporter

from softdepth.export.bench import bench
from softdepth.export.component import component
from softdepth.export.litex_module import litex_module
from softdepth.export.streams import CLOCK, streams_of
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.text.rtlil import ports_of
from softdepth.hdl.verilog import to_verilog
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import SOURCE, address_map, definitions
from softdepth.templates import render

REGISTERS = "registers.rdl"
HEADER = "registers.h"
PAGE = "registers.md"
PERIOD = 10.0
"""The clock period in the constraints, in nanoseconds: a value to start from."""


def axi_package(config: Config, name: str, options: AxiOptions) -> dict[str, str]:
    """The files of the package by their names.

    Verilog; a bench with what it sends and compares; the registers in SystemRDL, as a C header and as a
    page; instantiations in Verilog and VHDL; constraints; an IP-XACT component; a LiteX module; and a
    FuseSoC core, whose target ``lint`` has Verilator read it, and ``sim`` run the bench.
    """
    core = AxiCore(config, options)
    ports = [
        {"name": port.name, "direction": port.flow.name.lower(), "width": len(port.value)}  # type: ignore[arg-type]
        for port in ports_of(core)
    ]
    defined = definitions(config, options)
    values = {
        "name": name,
        "config": config,
        "ports": ports,
        "defined": defined,
        "clocks": clocked(ports),
        "version": version("softdepth"),
        "period": f"{PERIOD:.3f}",
        "half": f"{PERIOD / 2:.3f}",
    }
    written = {
        f"{name}.v": to_verilog(core, name),
        f"{name}_instance.v": render("softdepth.export", "instance.v", **values),
        f"{name}_instance.vhd": render("softdepth.export", "instance.vhd", **values),
        f"{name}_litex.py": litex_module(config, name, options, ports),
        f"{name}.core": render("softdepth.export", "fusesoc.core", **values),
        f"{name}.vlt": render("softdepth.export", "waivers.vlt", **values),
        **bench(config, name, options, ports),
        f"{name}.sdc": render("softdepth.export", "axi.sdc", **values),
        f"{name}.xdc": render("softdepth.export", "axi.xdc", **values),
        REGISTERS: "".join(f"`define {key} {value}\n" for key, value in defined.items()) + SOURCE.read_text(),
    }
    node = address_map(defined)
    written[f"{name}.xml"] = component(config, name, options.bus, ports, node)
    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        header, page = Path(folder) / HEADER, Path(folder) / PAGE
        CHeaderExporter().export(node, str(header))
        MarkdownExporter().export(node, str(page), input_files=[REGISTERS])
        return written | {HEADER: header.read_text(), PAGE: page.read_text()}


def clocked(ports: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """The clocks among the ports, and by direction which ports are synchronous to each, for constraints.

    All ports but those of streams are synchronous to the core's.
    """
    streams = streams_of(ports)
    clock_of = {port: each.clock for each in streams for port in each.ports.values()}
    found: dict[str, dict[str, Any]] = {
        name: {"name": name, "inputs": [], "outputs": []}
        for name in dict.fromkeys([CLOCK, *(each.clock for each in streams)])
    }
    for port in ports:
        if port["name"] not in found:
            text = port["name"] + ("*" if port["width"] > 1 else "")
            way = "inputs" if port["direction"] == "in" else "outputs"
            found[clock_of.get(port["name"], CLOCK)][way].append(text)
    return list(found.values())
