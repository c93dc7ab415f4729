"""The package as an IP-XACT component, IEEE 1685-2009: the edition that Vivado reads, too."""

import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

from peakrdl_ipxact import IPXACTExporter, Standard
from systemrdl.node import AddrmapNode

from softdepth.export.streams import CLOCK, Stream, streams_of
from softdepth.spec.bus import Bus
from softdepth.spec.config import Config
from softdepth.templates import render

WISHBONE = {
    "cyc": "CYC_I",
    "stb": "STB_I",
    "we": "WE_I",
    "adr": "ADR_I",
    "sel": "SEL_I",
    "dat_w": "DAT_I",
    "dat_r": "DAT_O",
    "ack": "ACK_O",
}
"""Signals of a target as the specification of Wishbone B4 names them."""


@dataclass
class Interface:
    """A bus interface.

    Members
    -------
    role : ``slave`` or ``master``, in the words of the standard's edition.
    vendor, library, type, version : of the bus definition; that of its signals is called ``_rtl`` besides.
    ports : names of the bus definition, and the core's ports.
    map : the registers are reached through it.
    """

    name: str
    role: str
    type: str
    ports: dict[str, str]
    parameters: dict[str, str] = field(default_factory=dict)
    vendor: str = "xilinx.com"
    library: str = "interface"
    version: str = "1.0"
    map: bool = False


def component(
    config: Config, name: str, bus: Bus, ports: Sequence[dict[str, Any]], registers: AddrmapNode
) -> str:
    """The component's XML.

    Parameters
    ----------
    ports : of the core, each with its name, direction (``in``, ``out``) and width.
    registers : the elaborated description.
    """
    return render(
        "softdepth.export",
        "component.xml",
        name=name,
        config=config,
        version=version("softdepth"),
        ports=ports,
        interfaces=_interfaces(bus, ports),
        memory_maps=_memory_maps(registers),
        memory_map=f"{registers.inst_name}_mmap",
    )


def _interfaces(bus: Bus, ports: Sequence[dict[str, Any]]) -> list[Interface]:
    """Streams, the registers' bus, clock, reset and interrupt, by the definitions of AMD's tools."""
    streams = streams_of(ports)
    registers = _bus(bus, [port["name"] for port in ports])
    own = {each.own_clock: each.prefix for each in streams if each.own_clock}
    rest = [*(each.prefix for each in streams if not each.own_clock), registers.name]
    clock = {"ASSOCIATED_BUSIF": ":".join(rest), "ASSOCIATED_RESET": "aresetn"}
    return [
        *(_stream(each) for each in streams),
        registers,
        _signal(CLOCK, "slave", "clock", "CLK", clock),
        *(_signal(name, "slave", "clock", "CLK", {"ASSOCIATED_BUSIF": of}) for name, of in own.items()),
        _signal("aresetn", "slave", "reset", "RST", {"POLARITY": "ACTIVE_LOW"}),
        _signal("irq", "master", "interrupt", "INTERRUPT", {"SENSITIVITY": "LEVEL_HIGH"}),
    ]


def _stream(stream: Stream) -> Interface:
    signals = {signal.upper(): port for signal, port in stream.ports.items()}
    return Interface(stream.prefix, "slave" if stream.sink else "master", "axis", signals)


def _signal(name: str, role: str, type_: str, logical: str, parameters: dict[str, str]) -> Interface:
    """An interface of one port."""
    return Interface(name, role, type_, {logical: name}, parameters, library="signal")


def _bus(bus: Bus, ports: Sequence[str]) -> Interface:
    if bus == "axi-lite":
        prefix = "s_axil_"
        signals = {port.removeprefix(prefix).upper(): port for port in ports if port.startswith(prefix)}
        return Interface("s_axil", "slave", "aximm", signals, {"PROTOCOL": "AXI4LITE"}, map=True)
    signals = {logical: f"wb_{physical}" for physical, logical in WISHBONE.items()}
    return Interface("wb", "slave", "wishbone", signals, vendor="opencores.org", version="b4", map=True)


def _memory_maps(registers: AddrmapNode) -> str:
    """The part of a component that describes the registers."""
    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        path = Path(folder) / "registers.xml"
        IPXACTExporter(standard=Standard.IEEE_1685_2009).export(registers, str(path))
        text = path.read_text()
    found = re.search(r"^ *<spirit:memoryMaps>.*</spirit:memoryMaps>", text, re.DOTALL | re.MULTILINE)
    assert found, "peakrdl-ipxact has left out the registers"
    return found[0]
