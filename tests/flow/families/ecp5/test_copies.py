"""Flip-flops that many cells read are copied, and nothing else changes."""

from itertools import groupby

import pytest

from softdepth.flow.families.ecp5 import copies
from softdepth.flow.families.ecp5.copies import copy_registers
from softdepth.flow.synthesis import TOP, Netlist
from tests.flow.circuits import Bit, Circuit

BUFFER = 0xAAAA
"""A table that gives its first input."""


def behind(netlist: Netlist) -> dict[Bit, tuple[str, dict]]:
    """Of each net the cell that drives it."""
    cells = netlist["modules"][TOP]["cells"]
    return {
        bit: (name, cell)
        for name, cell in cells.items()
        for port, (bit, *_) in cell["connections"].items()
        if cell["port_directions"][port] == "output"
    }


def readers(netlist: Netlist) -> dict[Bit, list[str]]:
    cells = netlist["modules"][TOP]["cells"]
    pins = sorted(
        (bits[0], name)
        for name, cell in cells.items()
        for port, bits in cell["connections"].items()
        if cell["port_directions"][port] == "input" and isinstance(bits[0], int)
    )
    return {bit: [name for _, name in found] for bit, found in groupby(pins, key=lambda pin: pin[0])}


def travelled(bit: Bit, drivers: dict[Bit, tuple[str, dict]]) -> int:
    """Registers between a net and the input that it comes from."""
    clocks = 0
    while bit in drivers:
        bit, clocks = drivers[bit][1]["connections"]["DI"][0], clocks + 1
    return clocks


@pytest.mark.parametrize("count", [4, 5, 12, 100])
def test_a_travelling_bit_becomes_a_tree(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every reader still gets the bit after as many clocks, and no flip-flop has more readers than it may."""
    monkeypatch.setattr(copies, "LOAD", 4 * copies.APART)
    m = Circuit()
    (clock,), (bit,) = m.input("clock", 1), m.input("bit", 1)
    for _ in range(4):
        bit = m.register(bit, clock)
    m.output("late", [bit])
    outs = [m.lut(BUFFER, bit) for _ in range(count)]
    netlist = m.netlist
    before = len(netlist["modules"][TOP]["cells"])
    gone = copy_registers(netlist)
    cells = netlist["modules"][TOP]["cells"]
    assert len(cells) == before - gone
    assert (gone < 0) == (count > 4)
    drivers = behind(netlist)
    for name, cell in cells.items():
        if cell["type"] == "TRELLIS_FF":
            assert len(readers(netlist).get(cell["connections"]["Q"][0], [])) <= 4, name
    for out in outs:
        assert travelled(drivers[out][1]["connections"]["A"][0], drivers) == 4
    assert travelled(netlist["modules"][TOP]["ports"]["late"]["bits"][0], drivers) == 4


def test_neighbours_share_a_copy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(copies, "LOAD", 4)
    m = Circuit()
    (clock,), (enable,) = m.input("clock", 1), m.input("enable", 1)
    bit = m.register(enable, clock)
    for value in m.input("values", 12):
        m.register(value, clock, enable=bit)
    netlist = m.netlist
    copy_registers(netlist)
    drivers = behind(netlist)
    cells = netlist["modules"][TOP]["cells"]
    groups: dict[str, list[int]] = {}
    for name, cell in cells.items():
        if isinstance(cell["connections"]["CE"][0], int):
            groups.setdefault(drivers[cell["connections"]["CE"][0]][0], []).append(int(name.split("_")[-1]))
    assert sorted(groups.values()) == [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]]


def test_copies_follow_the_borders_of_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A block that needs a copy of its own does not share it; small ones that are neighbours share one."""
    monkeypatch.setattr(copies, "LOAD", 4 * copies.APART)
    m = Circuit()
    (clock,), (bit,) = m.input("clock", 1), m.input("bit", 1)
    bit = m.register(bit, clock)
    for _ in range(11):
        m.lut(BUFFER, bit)
    netlist = m.netlist
    module = netlist["modules"][TOP]
    names = [f"lane_9.{k}" for k in range(3)] + [f"lane_10.a.{k}" for k in range(5)] + ["b.0", "c.0", "d.0"]
    tables = [name for name in module["cells"] if name.startswith("lut4")]
    for old, new in zip(tables, names, strict=True):
        module["cells"][new] = module["cells"].pop(old)
    copy_registers(netlist)
    drivers = behind(netlist)
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(drivers[module["cells"][name]["connections"]["A"][0]][0], []).append(name)
    assert sorted(map(sorted, groups.values())) == [
        ["b.0", "c.0", "d.0"],
        ["lane_10.a.0", "lane_10.a.1", "lane_10.a.2", "lane_10.a.3"],
        ["lane_10.a.4"],
        ["lane_9.0", "lane_9.1", "lane_9.2"],
    ]


def test_ports_of_several_bits_keep_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(copies, "LOAD", copies.APART)
    m = Circuit()
    (clock,), (bit,), (other,) = m.input("clock", 1), m.input("bit", 1), m.input("other", 1)
    bit = m.register(bit, clock)
    netlist = m.netlist
    cells = netlist["modules"][TOP]["cells"]
    for k in range(2):
        cells[f"ram_{k}"] = {
            "type": "TRELLIS_DPR16X4",
            "parameters": {},
            "port_directions": {"RAD": "input"},
            "connections": {"RAD": [bit, other, bit, "0"]},
        }
    assert copy_registers(netlist) == -1
    addresses = [cells[f"ram_{k}"]["connections"]["RAD"] for k in range(2)]
    assert all(address[0] == address[2] and address[1::2] == [other, "0"] for address in addresses)
    assert addresses[0][0] != addresses[1][0]


def test_a_flip_flop_that_reads_itself_stays_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each copy would be one reader more, which would need a copy."""
    monkeypatch.setattr(copies, "LOAD", 2 * copies.APART)
    m = Circuit()
    (clock,) = m.input("clock", 1)
    bit = m.register("0", clock)
    netlist = m.netlist
    (cell,) = netlist["modules"][TOP]["cells"].values()
    cell["connections"]["DI"] = [bit]
    for _ in range(5):
        m.lut(BUFFER, bit)
    assert copy_registers(netlist) == 0
