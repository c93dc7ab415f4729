"""What netlists of other families take: cell by cell, and of a core that yosys maps."""

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.flow.other_families import OTHER_FAMILIES, Taken, synthesised
from softdepth.flow.synthesis import to_shared_rtlil
from softdepth.spec.errors import ToolError


@pytest.mark.parametrize(
    ("family", "cells", "taken"),
    [
        ("7-series", {"LUT6": 3, "SRL16E": 2, "RAM32M": 1, "CARRY4": 7, "MUXF7": 1}, Taken(lut=9)),
        ("7-series", {"FDRE": 3, "FDSE": 1, "RAMB18E1": 1, "RAMB36E1": 2, "DSP48E1": 1}, Taken(0, 4, 5, 1)),
        ("gowin", {"LUT1": 1, "ALU": 2, "RAM16SDP4": 1, "MUX2_LUT5": 5, "GND": 1}, Taken(lut=7)),
        (
            "gowin",
            {"DFF": 1, "DFFSE": 1, "DFFRE": 1, "DPB": 1, "SDPX9B": 1, "MULT36X36": 1},
            Taken(0, 3, 2, 4),
        ),
        ("nexus", {"LUT4": 1, "CCU2": 2, "WIDEFN9": 1, "DPR16X4": 1, "VHI": 1}, Taken(lut=11)),
        (
            "nexus",
            {"FD1P3IX": 2, "FD1P3JX": 1, "PDPSC16K": 1, "MULT18X18": 1, "MULT18X36": 1},
            Taken(0, 3, 1, 3),
        ),
    ],
)
def test_cells_take_what_the_family_has(family: str, cells: dict[str, int], taken: Taken) -> None:
    assert OTHER_FAMILIES[family].taken(cells) == taken


@pytest.mark.parametrize("family", OTHER_FAMILIES)
def test_a_cell_of_none_is_not_passed_over(family: str) -> None:
    with pytest.raises(ToolError, match=r"TRELLIS_FF, which .* is not known to have"):
        OTHER_FAMILIES[family].taken({"TRELLIS_FF": 1})


class OfEverything(wiring.Component):
    """Memory in a block and in look-up tables, a multiplier, a carry chain, registers."""

    a: In(16)
    b: In(16)
    write: In(1)
    product: Out(32)
    word: Out(16)
    few: Out(8)
    total: Out(24)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.block = block = Memory(shape=16, depth=1024, init=[])
        m.submodules.few = few = Memory(shape=8, depth=16, init=[])
        block_write, block_read = block.write_port(), block.read_port(transparent_for=[])
        few_write, few_read = few.write_port(), few.read_port(domain="comb")
        held = Signal(16, reset_less=True)
        for port in (block_write, few_write):
            m.d.comb += [port.addr.eq(self.a), port.data.eq(self.b), port.en.eq(self.write)]
        m.d.comb += [block_read.addr.eq(self.b), few_read.addr.eq(self.b)]
        m.d.comb += [self.word.eq(block_read.data), self.few.eq(few_read.data)]
        m.d.sync += [held.eq(self.a), self.product.eq(held * self.b), self.total.eq(self.total + self.a)]
        return m


@pytest.mark.slow
@pytest.mark.parametrize("family", OTHER_FAMILIES)
def test_every_cell_that_yosys_takes_is_known(family: str) -> None:
    target = OTHER_FAMILIES[family]
    taken = target.taken(synthesised(to_shared_rtlil(OfEverything()), target))
    assert (taken.ram, taken.dsp) == (1, 1)
    assert 8 + 24 // 4 <= taken.lut < 100
    assert 24 <= taken.ff < 200  # some families keep registers of multiplier and memory outside
