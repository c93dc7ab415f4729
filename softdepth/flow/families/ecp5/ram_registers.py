"""Moves the flip-flops behind an ECP5 block RAM into it."""

from softdepth.flow.families.ecp5.nets import Nets
from softdepth.flow.netlist import Cell, Netlist

OUTPUTS = 18
"""Data outputs of a port."""

RAM = "DP16KD"


def absorb_ram_registers(netlist: Netlist) -> int:
    """Use a block RAM's own output registers where all its outputs are registered, in place.

    Without them a block RAM takes most of a 100 MHz clock to show its word. Yosys does not use them.
    Returns how many flip-flops went. A port's registers have one clock enable and no reset here:
    flip-flops with others, or outputs that something else reads too, leave the port as it is. A word of
    36 bits comes from both ports' outputs: both get the clock enable, and either none or all are registered.
    """
    removed = 0
    for module in netlist["modules"].values():
        nets = Nets(module)
        for cell in [cell for cell in nets.cells.values() if cell["type"] == RAM]:
            removed += sum(_absorb(nets, cell, sides) for sides in (["AB"] if _double(cell) else ["A", "B"]))
    return removed


def _absorb(nets: Nets, cell: Cell, sides: str) -> int:
    registers = nets.registers_behind(cell, (f"DO{side}{k}" for side in sides for k in range(OUTPUTS)))
    control = nets.common_control(registers.values())
    if control is None or any(cell["parameters"][f"REGMODE_{side}"] != "NOREG" for side in sides):
        return 0
    clock, enable = control
    if any([clock] != cell["connections"][f"CLK{side}"] for side in sides):
        return 0
    for side in sides:
        cell["parameters"][f"REGMODE_{side}"] = "OUTREG"
        cell["connections"][f"OCE{side}"] = [enable]
    nets.take_in(cell, registers)
    return len(registers)


def _double(cell: Cell) -> bool:
    """Whether a word takes the data pins of both ports."""
    return any(int(cell["parameters"][f"DATA_WIDTH_{side}"], 2) > OUTPUTS for side in "AB")
