"""Absorbs logic in front of ECP5 adders into the adders themselves.

Each half of a carry cell (CCU2C) has a four-input table of its own, of which yosys uses two or three
inputs. Conditional negation and selection in front of an adder, as in ``a + (b ^ n)`` or
``a + (s ? b : c)``, often fit into it: one LUT4 a bit less, and one level of logic.
"""

from collections.abc import Iterator
from functools import cache
from itertools import permutations, product
from typing import Any

from softdepth.flow.families.ecp5.nets import Nets
from softdepth.flow.netlist import Bit, Netlist

PINS = "ABCD"
MAX_PASSES = 4


def fuse_carries(netlist: Netlist) -> int:
    """Move lookup tables into the carry cells that they feed, in place; returns how many went.

    A table goes only if every one of its readers is a carry cell that can take it. The carry cell's
    new table is derived by going through all values of its inputs, never by matching forms.
    """
    return sum(_Module(module).fuse() for module in netlist["modules"].values())


class _Module:
    """One module of the netlist, indexed by who drives and who reads a net."""

    def __init__(self, module: dict[str, Any]) -> None:
        self._nets = Nets(module)
        self._tables: dict[Bit, str] = {
            cell["connections"]["Z"][0]: name
            for name, cell in self._nets.cells.items()
            if cell["type"] == "LUT4"
        }

    def fuse(self) -> int:
        removed = 0
        for _ in range(MAX_PASSES):
            gone = [bit for bit in list(self._tables) if self._absorb(bit)]
            removed += len(gone)
            if not gone:
                break
        return removed

    def _absorb(self, output: Bit) -> bool:
        """Move the table that drives ``output`` into all of its readers, or leave it."""
        cells = self._nets.cells
        readers = self._nets.readers[output]
        if output in self._nets.exported or not readers:
            return False
        halves = {(name, port[-1]) for name, port in readers}
        if any(cells[name]["type"] != "CCU2C" or port == "CIN" for name, port in readers):
            return False
        name = self._tables[output]
        table = cells[name]
        plans = []
        for cell, half in sorted(halves):
            plan = _plan(cells[cell], half, output, table)
            if plan is None:
                return False
            plans.append((cell, half, *plan))
        for cell, half, init, bits in plans:
            self._rewire(cell, half, init, bits)
        del self._tables[output]
        self._nets.remove(name)
        return True

    def _rewire(self, name: str, half: str, init: int, bits: list[Bit]) -> None:
        for pin, bit in zip(PINS, bits, strict=True):
            self._nets.move(name, pin + half, bit)
        self._nets.cells[name]["parameters"][f"INIT{half}"] = f"{init:016b}"


def _plan(
    cell: dict[str, Any], half: str, output: Bit, table: dict[str, Any]
) -> tuple[int, list[Bit]] | None:
    """The carry cell's new table and inputs once it computes ``output`` by itself; None: it cannot."""
    if cell["parameters"][f"INJECT1_{half}"] != "NO":
        return None
    pins = [cell["connections"][pin + half][0] for pin in PINS]
    inner = [table["connections"].get(pin, ["0"])[0] for pin in PINS]
    leaves = list(dict.fromkeys(b for b in [*pins, *inner] if not isinstance(b, str) and b != output))
    if len(leaves) > len(PINS) or any(b not in ("0", "1") for b in [*pins, *inner] if isinstance(b, str)):
        return None

    def index(bit: Bit) -> int | str:
        return bit if isinstance(bit, str) else "out" if bit == output else leaves.index(bit)

    found = _fit(
        int(cell["parameters"][f"INIT{half}"], 2),
        tuple(map(index, pins)),
        int(table["parameters"]["INIT"], 2),
        tuple(map(index, inner)),
        len(leaves),
    )
    if found is None:
        return None
    init, order = found
    return init, [leaves[i] if isinstance(i, int) else i for i in order]


@cache
def _fit(
    init: int, pins: tuple[int | str, ...], inner_init: int, inner: tuple[int | str, ...], leaves: int
) -> tuple[int, tuple[int | str, ...]] | None:
    """A table and a pin order for the same sum and carry.

    A half propagates its carry where its table is 1. Elsewhere the carry is what the table says for
    A and B with C = D = 0: the part of it that is shared between both roles.
    """
    wanted: dict[tuple[int, ...], tuple[int, int]] = {}
    for values in product((0, 1), repeat=leaves):
        out = inner_init >> _address(inner, values, 0) & 1
        address = _address(pins, values, out)
        wanted[values] = init >> address & 1, init >> (address & 0b0011) & 1
    for order in _orders(leaves):
        entries: dict[int, int] = {}
        fits = True
        for values, (propagate, generate) in wanted.items():
            address = _address(order, values, 0)
            demands = [(address, propagate)] + ([] if propagate else [(address & 0b0011, generate)])
            for where, value in demands:
                fits = fits and entries.setdefault(where, value) == value
        if fits:
            return sum(value << where for where, value in entries.items()), order
    return None


def _orders(leaves: int) -> Iterator[tuple[int | str, ...]]:
    """Ways to connect the pins A to D; a spare pin D is tied to 1, which frees the shared entries."""
    spare: tuple[int | str, ...] = ("0",) * max(0, len(PINS) - 1 - leaves) + ("1",) * (leaves < len(PINS))
    for order in permutations(range(leaves)):
        yield (*order, *spare)


def _address(pins: tuple[int | str, ...], values: tuple[int, ...], out: int) -> int:
    bits = (out if pin == "out" else int(pin) if isinstance(pin, str) else values[pin] for pin in pins)
    return sum(bit << i for i, bit in enumerate(bits))
