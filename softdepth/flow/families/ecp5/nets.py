"""What the passes need to know about a netlist: what reads and what drives a net."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from softdepth.flow.netlist import Bit, Cell

FLIP_FLOP = "TRELLIS_FF"


class Nets:
    """The nets of one module.

    Members
    -------
    cells : the module's cells by name.
    readers : for each net, the cells and ports that read it.
    exported : nets of the module's own ports.
    """

    def __init__(self, module: dict[str, Any]) -> None:
        self.cells: dict[str, Cell] = module["cells"]
        self.readers: dict[Bit, set[tuple[str, str]]] = defaultdict(set)
        self.exported = {bit for port in module["ports"].values() for bit in port["bits"]}
        self._flip_flops: dict[Bit, str] = {}
        for name, cell in self.cells.items():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] != "output":
                    for bit in bits:
                        self.readers[bit].add((name, port))
                elif cell["type"] == FLIP_FLOP:
                    self._flip_flops[bits[0]] = name

    def used(self, bit: Bit) -> bool:
        """Whether anything reads a net."""
        return bool(self.readers[bit]) or bit in self.exported

    def flip_flop_of(self, bit: Bit) -> str | None:
        """The flip-flop that drives a net."""
        return self._flip_flops.get(bit)

    def register_of(self, bit: Bit) -> str | None:
        """The plain flip-flop that drives a net."""
        name = self._flip_flops.get(bit)
        return name if name is not None and _plain(self.cells[name]) else None

    def only_register(self, bit: Bit) -> str | None:
        """The plain flip-flop that a net goes to, if it goes there only."""
        if bit in self.exported or len(self.readers[bit]) != 1:
            return None
        ((name, port),) = self.readers[bit]
        cell = self.cells[name]
        return name if cell["type"] == FLIP_FLOP and port == "DI" and _plain(cell) else None

    def control(self, name: str) -> tuple[Bit, Bit]:
        """A flip-flop's clock and its clock enable."""
        cell = self.cells[name]
        always = cell["parameters"].get("CEMUX", "CE").strip() == "1"
        enable = "1" if always else cell["connections"].get("CE", ["1"])[0]
        return cell["connections"]["CLK"][0], enable

    def common_control(self, names: Iterable[str]) -> tuple[Bit, Bit] | None:
        """The clock and the clock enable of flip-flops that have the same, if there are any."""
        controls = {self.control(name) for name in names}
        return controls.pop() if len(controls) == 1 else None

    def registers_behind(self, cell: Cell, ports: Iterable[str]) -> dict[str, str]:
        """The flip-flops that a cell's outputs go to, by port: those that are read, if all go to one only."""
        found: dict[str, str] = {}
        for port in ports:
            bit, *_ = cell["connections"].get(port) or ["x"]
            if self.used(bit):
                name = self.only_register(bit)
                if name is None:
                    return {}
                found[port] = name
        return found

    def take_in(self, cell: Cell, registers: Mapping[str, str]) -> None:
        """Let a cell's outputs take the place of the flip-flops behind them, which are removed."""
        for port, name in registers.items():
            cell["connections"][port] = self.cells[name]["connections"]["Q"]
            self.remove(name)

    def move(self, name: str, port: str, bit: Bit) -> None:
        """Connect an input of a cell to another net."""
        cell = self.cells[name]
        for old in cell["connections"].get(port, []):
            self.readers[old].discard((name, port))
        cell["connections"][port] = [bit]
        cell["port_directions"][port] = "input"
        self.readers[bit].add((name, port))

    def exchange(self, name: str, port: str, old: Bit, new: Bit) -> None:
        """Connect those bits of an input that a net goes to, to another net."""
        connections = self.cells[name]["connections"]
        connections[port] = [new if bit == old else bit for bit in connections[port]]
        self.readers[old].discard((name, port))
        self.readers[new].add((name, port))

    def copy(self, name: str, output: str, bit: Bit, copy: str) -> None:
        """Add a cell like another one but for its output, which drives the net `bit`."""
        cell = deepcopy(self.cells[name])
        cell["connections"][output] = [bit]
        self.cells[copy] = cell
        for port, bits in cell["connections"].items():
            if port != output:
                for read in bits:
                    self.readers[read].add((copy, port))

    def remove(self, name: str) -> None:
        """Take a cell away."""
        for port, bits in self.cells.pop(name)["connections"].items():
            for bit in bits:
                self.readers[bit].discard((name, port))
                if self._flip_flops.get(bit) == name:
                    del self._flip_flops[bit]


def _plain(flip_flop: Cell) -> bool:
    """Rising edge, no reset, 0 at the start: what registers inside of other cells can be."""
    parameters = flip_flop["parameters"]
    return (
        parameters.get("CLKMUX", "CLK").strip() == "CLK"
        and parameters.get("REGSET", "RESET").strip() == "RESET"
        and parameters.get("CEMUX", "CE").strip() in ("1", "CE")
        and flip_flop["connections"].get("LSR", ["0"]) == ["0"]
    )
