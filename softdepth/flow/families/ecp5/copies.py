"""Copies the flip-flops that many cells read, so that each copy can stand near its readers."""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

from softdepth.flow.families.ecp5.nets import FLIP_FLOP, Nets
from softdepth.flow.netlist import Netlist

LOAD = 128
"""The largest load of a flip-flop: each clock enable or reset counts 1, each other input `APART`."""

APART = 4
"""Flip-flops that stand together have a clock enable and a reset in common, but no other input."""

Pin = tuple[str, str]
"""A cell and its port."""


def copy_registers(netlist: Netlist) -> int:
    """Let no flip-flop have more than `LOAD` readers, in place: there are as many copies as that takes.

    The clock enable of all lanes goes to half of the FPGA, which takes longer than what a lane computes
    within a clock. Neither yosys nor nextpnr copies registers. Readers of one block share a copy, or
    several if they are many; small blocks share one with their neighbours. Blocks are known by the cells'
    names. A copy reads what the flip-flop reads, so that this may need copies in turn: a bit that travels
    through a few registers becomes a tree.

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
        pins = readers[output]
        if _load(pins) <= LOAD or any(reader == name for reader, _ in pins):
            return False
        for group in _groups(sorted(pins, key=_natural))[1:]:
            self._last += 1
            copy = f"{name}_copy_{self._last}"
            self._names[f"{copy}_Q"] = {"hide_name": 0, "bits": [self._last], "attributes": {}}
            self._nets.copy(name, "Q", self._last, copy)
            for reader, port in group:
                self._nets.exchange(reader, port, output, self._last)
        return True

    def _read_by(self, name: str) -> Iterator[str]:
        """The flip-flops that one reads directly."""
        for bits in self._nets.cells[name]["connections"].values():
            for bit in bits:
                before = self._nets.flip_flop_of(bit)
                if before not in (None, name):
                    yield before


def _load(pins: Iterable[Pin]) -> int:
    return sum(1 if port in ("CE", "LSR") else APART for _, port in pins)


def _groups(pins: Sequence[Pin], depth: int = 0) -> list[list[Pin]]:
    """Sorted pins in groups of up to `LOAD`, along the borders of blocks where that goes."""
    if _load(pins) <= LOAD:
        return [list(pins)]
    blocks = [list(block) for _, block in groupby(pins, key=lambda pin: pin[0].split(".")[: depth + 1])]
    if len(blocks) == 1 and pins[0][0].count(".") < depth:  # names of one block, which only differ at the end
        blocks = [[pin] for pin in pins]
    groups: list[list[Pin]] = []
    open_group = False  # the last group consists of whole blocks, and may take more
    for block in blocks:
        whole = _load(block) <= LOAD
        if whole and open_group and _load(groups[-1]) + _load(block) <= LOAD:
            groups[-1] += block
        else:
            groups += _groups(block, depth + 1)
        open_group = whole
    return groups


def _natural(pin: Pin) -> list[tuple[int, str]]:
    """Sorts names by the numbers in them: ``lane_9`` before ``lane_10``."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", pin[0])]
