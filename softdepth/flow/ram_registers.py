"""Moves the flip-flops behind an ECP5 block RAM into it."""

from collections import defaultdict
from typing import Any

Netlist = dict[str, Any]
"""What yosys ``write_json`` writes."""

OUTPUTS = 18
"""Data outputs of a port."""

RAM = "DP16KD"
FLIP_FLOP = "TRELLIS_FF"


def absorb_ram_registers(netlist: Netlist) -> int:
    """Use a block RAM's own output registers where all its outputs are registered, in place.

    Without them a block RAM takes most of a 100 MHz clock to show its word. Yosys does not use them.
    Returns how many flip-flops went. A port's registers have one clock enable and no reset here:
    flip-flops with others, or outputs that something else reads too, leave the port as it is.
    """
    return sum(_absorb(module) for module in netlist["modules"].values())


def _absorb(module: dict[str, Any]) -> int:
    cells = module["cells"]
    readers: dict[int, list[tuple[str, str]]] = defaultdict(list)
    for name, cell in cells.items():
        for port, bits in cell["connections"].items():
            if cell["port_directions"][port] != "output":
                for bit in bits:
                    readers[bit].append((name, port))
    exported = {bit for port in module["ports"].values() for bit in port["bits"]}
    removed = 0
    for cell in [cell for cell in cells.values() if cell["type"] == RAM and not _double(cell)]:
        for side in "AB":
            used = {
                port: bits[0]
                for port in (f"DO{side}{k}" for k in range(OUTPUTS))
                if (bits := cell["connections"].get(port)) and (readers[bits[0]] or bits[0] in exported)
            }
            registers = {port: _register(cells, readers[bit], bit in exported) for port, bit in used.items()}
            enables = {_enable(cells[name]) for name in registers.values() if name is not None}
            clocks = {tuple(cells[name]["connections"]["CLK"]) for name in registers.values() if name}
            if not used or None in registers.values() or len(enables) != 1:
                continue
            if cell["parameters"][f"REGMODE_{side}"] != "NOREG":
                continue
            if clocks != {tuple(cell["connections"][f"CLK{side}"])}:
                continue
            (enable,) = enables
            cell["parameters"][f"REGMODE_{side}"] = "OUTREG"
            cell["connections"][f"OCE{side}"] = [enable]
            for port, name in registers.items():
                cell["connections"][port] = cells.pop(name)["connections"]["Q"]
                removed += 1
    return removed


def _double(cell: dict[str, Any]) -> bool:
    """Whether a word takes the data pins of both ports."""
    return any(int(cell["parameters"][f"DATA_WIDTH_{side}"], 2) > OUTPUTS for side in "AB")


def _register(cells: dict[str, Any], readers: list[tuple[str, str]], exported: bool) -> str | None:
    """The flip-flop that an output goes to, if it goes there only, and may move."""
    if exported or len(readers) != 1:
        return None
    name, port = readers[0]
    cell = cells[name]
    if cell["type"] != FLIP_FLOP or port != "DI":
        return None
    parameters = cell["parameters"]
    plain = (
        parameters.get("CLKMUX", "CLK").strip() == "CLK"
        and parameters.get("REGSET", "RESET").strip() == "RESET"
        and parameters.get("CEMUX", "CE").strip() in ("1", "CE")
        and cell["connections"].get("LSR", ["0"]) == ["0"]
    )
    return name if plain else None


def _enable(cell: dict[str, Any]) -> int | str:
    if cell["parameters"].get("CEMUX", "CE").strip() == "1":
        return "1"
    return cell["connections"].get("CE", ["1"])[0]
