"""What netlists of other families take: cell by cell, and of a core that yosys maps."""

import pytest

from softdepth.flow.other_families import OTHER_FAMILIES, Taken, synthesised
from softdepth.flow.synthesis import to_shared_rtlil
from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config
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


@pytest.mark.slow
@pytest.mark.parametrize("family", OTHER_FAMILIES)
def test_every_cell_of_a_core_is_known(family: str) -> None:
    """With memories in blocks and in look-up tables, carry chains, and multipliers."""
    config = Config.preset("lite").override(["disparities=4", "lanes=2", "max_width=320", "max_height=64"])
    target = OTHER_FAMILIES[family]
    taken = target.taken(synthesised(to_shared_rtlil(StereoCore(config)), target))
    assert taken.lut > 500
    assert taken.ff > 500
    assert taken.ram >= 4
    assert taken.dsp >= 4
