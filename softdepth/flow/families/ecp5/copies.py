"""Copies the flip-flops that many cells read, so that each copy can stand near its readers."""

import re
from collections.abc import Iterator
from typing import Any

from softdepth.flow.netlist import FLIP_FLOP, Netlist, Nets

READERS = 128
"""Most pins that read one flip-flop."""


def copy_registers(netlist: Netlist) -> int:
    """Let no flip-flop have more than `READERS` readers, in place: there are as many copies as that takes.

    The clock enable of all lanes goes to half of the FPGA, which takes longer than what a lane computes
    within a clock. Neither yosys nor nextpnr copies registers. Readers whose names are neighbours share a
    copy: they belong to one lane, or to the next. A copy reads what the flip-flop reads, so that this may
    need copies in turn: a bit that travels through a few registers becomes a tree.

    Returns how many cells went, which is minus the number of copies.
    """
    return -sum(_Module(module).copy() for module in netlist["modules"].values())


class _Module:
    """One module of the netlist."""

    def __init__(self, module: dict[str, Any]) -> None:
        self._nets = Nets(module)
        self._names = module["netnames"]
        known = {
            bit for cell in self._nets.cells.values() for bits in cell["connections"].values() for bit in bits
        }
        known.update(bit for net in self._names.values() for bit in net["bits"])
        self._last = max((bit for bit in known if isinstance(bit, int)), default=1)

    def copy(self) -> int:
        """Returns how many copies were made."""
        cells = self._nets.cells
        waiting = [name for name, cell in cells.items() if cell["type"] == FLIP_FLOP]
        before = len(cells)
        while waiting:
            name = waiting.pop()
            if self._copy(name):
                waiting += self._read_by(name)
        return len(cells) - before

    def _copy(self, name: str) -> bool:
        """Copy one flip-flop, if it has too many readers; those of the module's ports keep the original."""
        cells, readers = self._nets.cells, self._nets.readers
        output = cells[name]["connections"]["Q"][0]
        ordered = sorted(readers[output], key=_natural)
        if len(ordered) <= READERS or any(reader == name for reader, _ in ordered):
            return False
        for start in range(READERS, len(ordered), READERS):
            self._last += 1
            copy = f"{name}_copy_{self._last}"
            self._names[f"{copy}_Q"] = {"hide_name": 0, "bits": [self._last], "attributes": {}}
            self._nets.copy(name, "Q", self._last, copy)
            for reader, port in ordered[start : start + READERS]:
                pins = cells[reader]["connections"][port]
                assert pins == [output], "a pin of an ECP5 cell is one bit"
                self._nets.move(reader, port, self._last)
        return True

    def _read_by(self, name: str) -> Iterator[str]:
        """The flip-flops that one reads directly."""
        for bits in self._nets.cells[name]["connections"].values():
            for bit in bits:
                before = self._nets.flip_flop_of(bit)
                if before not in (None, name):
                    yield before


def _natural(reader: tuple[str, str]) -> list[tuple[int, str]]:
    """Sorts names by the numbers in them: ``lane_9`` before ``lane_10``."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", reader[0])]
