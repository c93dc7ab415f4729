"""Moves the flip-flops before and behind an ECP5 multiplier into it."""

from collections.abc import Sequence

from softdepth.flow.families.ecp5.nets import Nets
from softdepth.flow.netlist import Bit, Netlist

MULTIPLIER = "MULT18X18D"
OPERANDS = [f"{operand}{k}" for operand in "AB" for k in range(18)]
PRODUCT = [f"P{k}" for k in range(36)]


def absorb_multiplier_registers(netlist: Netlist) -> int:
    """Use a multiplier's own registers where its operands come from flip-flops, or its product goes to
    them, in place.

    Multipliers stand in few rows of an FPGA, far from most of the logic: with registers of their own the
    way there and the way back are a clock each. Yosys does not use them. Flip-flops of operands that
    something else reads too stay for that. Returns how many flip-flops went. The registers on each side
    have one clock enable and no reset here: flip-flops with others leave that side as it is.
    """
    removed = 0
    for module in netlist["modules"].values():
        nets = Nets(module)
        for name in [name for name, cell in nets.cells.items() if cell["type"] == MULTIPLIER]:
            removed += _operands(nets, name) + _product(nets, name)
    return removed


def _operands(nets: Nets, name: str) -> int:
    cell = nets.cells[name]
    pins = {pin: cell["connections"][pin][0] for pin in OPERANDS}
    found = {pin: nets.register_of(bit) for pin, bit in pins.items() if not isinstance(bit, str)}
    registers = [register for register in found.values() if register is not None]
    control = nets.common_control(registers)
    if control is None or len(registers) < len(found):
        return 0
    _use(nets, name, ("INPUTA", "INPUTB"), *control)
    before = len(nets.cells)
    for pin, register in found.items():
        assert register is not None
        nets.move(name, pin, nets.cells[register]["connections"]["DI"][0])
    for register in dict.fromkeys(registers):
        if not nets.used(nets.cells[register]["connections"]["Q"][0]):
            nets.remove(register)
    return before - len(nets.cells)


def _product(nets: Nets, name: str) -> int:
    cell = nets.cells[name]
    registers = nets.registers_behind(cell, PRODUCT)
    control = nets.common_control(registers.values())
    if control is None or cell["connections"].get("CLK0", [control[0]]) != [control[0]]:
        return 0
    _use(nets, name, ("OUTPUT",), *control)
    nets.take_in(cell, registers)
    return len(registers)


def _use(nets: Nets, name: str, registers: Sequence[str], clock: Bit, enable: Bit) -> None:
    # Each side has a clock enable of its own.
    number = "1" if "OUTPUT" in registers else "0"
    nets.move(name, "CLK0", clock)
    nets.move(name, f"CE{number}", enable)
    nets.move(name, "RST0", "0")
    for register in registers:
        nets.cells[name]["parameters"] |= {
            f"REG_{register}_CLK": "CLK0",
            f"REG_{register}_CE": f"CE{number}",
            f"REG_{register}_RST": "RST0",
        }
