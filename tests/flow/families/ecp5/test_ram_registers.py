"""Block RAMs take in the flip-flops behind them, all of a word or none."""

from typing import Any

import pytest

from softdepth.flow.families.ecp5.ram_registers import absorb_ram_registers
from softdepth.flow.netlist import Netlist
from softdepth.flow.synthesis import TOP

CLOCK, ENABLE = 2, 3


def ram(width: int, *, other: str = "", enables: tuple[Any, Any] = ("1", "1")) -> Netlist:
    """A block RAM that is read by port B, with a flip-flop behind each pin of the word.

    Parameters
    ----------
    other : a pin that a LUT4 reads too.
    enables : of the flip-flops behind A's pins and behind B's.
    """
    pins = [f"DO{side}{k}" for side in ("AB" if width > 18 else "B") for k in range(18)]
    nets = {pin: 10 + k for k, pin in enumerate(pins)}
    cells: dict[str, Any] = {
        "ram": {
            "type": "DP16KD",
            "parameters": {
                **{f"DATA_WIDTH_{side}": f"{width:032b}" for side in "AB"},
                **{f"REGMODE_{side}": "NOREG" for side in "AB"},
            },
            "port_directions": {"CLKA": "input", "CLKB": "input", "OCEA": "input", "OCEB": "input"}
            | dict.fromkeys(pins, "output"),
            "connections": {"CLKA": [CLOCK], "CLKB": [CLOCK], "OCEA": ["0"], "OCEB": ["1"]}
            | {pin: [net] for pin, net in nets.items()},
        }
    }
    for k, (pin, net) in enumerate(nets.items()):
        enable = enables["AB".index(pin[2])]
        cells[f"register_{k}"] = {
            "type": "TRELLIS_FF",
            "parameters": {"CLKMUX": "CLK", "CEMUX": "CE", "REGSET": "RESET"},
            "port_directions": dict.fromkeys(("CLK", "CE", "LSR", "DI"), "input") | {"Q": "output"},
            "connections": {"CLK": [CLOCK], "CE": [enable], "LSR": ["0"], "DI": [net], "Q": [100 + k]},
        }
    if other:
        cells["table"] = {
            "type": "LUT4",
            "parameters": {},
            "port_directions": {"A": "input", "Z": "output"},
            "connections": {"A": [nets[other]], "Z": [200]},
        }
    ports = {"word": {"direction": "output", "bits": [100 + k for k in range(len(pins))]}}
    return {"modules": {TOP: {"ports": ports, "cells": cells, "netnames": {}}}}


@pytest.mark.parametrize("enable", ["1", ENABLE])
@pytest.mark.parametrize(("width", "sides"), [(18, "B"), (36, "AB")])
def test_a_whole_word_is_taken_in(width: int, sides: str, enable: Any) -> None:
    netlist = ram(width, enables=(enable, enable))
    assert absorb_ram_registers(netlist) == width
    (cell,) = netlist["modules"][TOP]["cells"].values()
    for side in sides:
        assert cell["parameters"][f"REGMODE_{side}"] == "OUTREG"
        assert cell["connections"][f"OCE{side}"] == [enable]
        base = 100 + 18 * sides.index(side)
        assert [cell["connections"][f"DO{side}{k}"] for k in range(18)] == [[base + k] for k in range(18)]


@pytest.mark.parametrize("faults", [{"other": "DOA3"}, {"other": "DOB0"}, {"enables": ("1", ENABLE)}])
def test_half_a_word_of_36_bits_is_not(faults: dict[str, Any]) -> None:
    """Its halves would leave the block RAM in different clocks."""
    netlist = ram(36, **faults)
    assert absorb_ram_registers(netlist) == 0
    parameters = netlist["modules"][TOP]["cells"]["ram"]["parameters"]
    assert {parameters["REGMODE_A"], parameters["REGMODE_B"]} == {"NOREG"}
