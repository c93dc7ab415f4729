"""Small circuits of ECP5 cells, and what they compute for every input."""

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.flow.synthesis import TOP, Netlist

Bit = int | str
Column = NDArray[np.uint8]

ADD = 0x96AA
"""yosys' table for ``A + B`` (C inverts B, D is 1): sum and propagate ``A ^ B ^ C``, generate A."""

PINS = "ABCD"


class Circuit:
    """A netlist in the making, as yosys writes it."""

    def __init__(self) -> None:
        self._cells: dict[str, Any] = {}
        self._ports: dict[str, Any] = {}
        self._nets = iter(range(2, 100_000))

    def input(self, name: str, width: int) -> list[Bit]:
        bits: list[Bit] = [next(self._nets) for _ in range(width)]
        self._ports[name] = {"direction": "input", "bits": bits}
        return bits

    def output(self, name: str, bits: list[Bit]) -> None:
        self._ports[name] = {"direction": "output", "bits": bits}

    def lut(self, init: int, *pins: Bit) -> Bit:
        """A LUT4; pins that are left out are 0."""
        out = next(self._nets)
        wired = dict(zip(PINS, [*pins, *["0"] * (4 - len(pins))], strict=True))
        self._add("LUT4", {"INIT": f"{init:016b}"}, {p: [b] for p, b in wired.items()}, {"Z": [out]})
        return out

    def carry(self, inits: tuple[int, int], halves: list[list[Bit]], cin: Bit) -> list[Bit]:
        """A CCU2C; its S0, S1 and COUT."""
        outs: list[Bit] = [next(self._nets) for _ in range(3)]
        inputs = {f"{pin}{k}": [bit] for k in (0, 1) for pin, bit in zip(PINS, halves[k], strict=True)}
        parameters = {f"INIT{k}": f"{init:016b}" for k, init in enumerate(inits)}
        parameters |= {"INJECT1_0": "NO", "INJECT1_1": "NO"}
        found = {name: [out] for name, out in zip(("S0", "S1", "COUT"), outs, strict=True)}
        self._add("CCU2C", parameters, inputs | {"CIN": [cin]}, found)
        return outs

    def register(self, bit: Bit, clock: Bit, enable: Bit = "1", reset: Bit = "0") -> Bit:
        """A flip-flop behind a net."""
        out = next(self._nets)
        inputs = {"CLK": [clock], "CE": [enable], "LSR": [reset], "DI": [bit]}
        parameters = {"CLKMUX": "CLK", "CEMUX": "CE", "REGSET": "RESET"}
        self._add("TRELLIS_FF", parameters, inputs, {"Q": [out]})
        return out

    def multiply(self, a: list[Bit], b: list[Bit]) -> list[Bit]:
        """A MULT18X18D of two words without sign; the lowest 36 bits are its product."""
        wide = {"A": [*a, *["0"] * (18 - len(a))], "B": [*b, *["0"] * (18 - len(b))]}
        inputs: dict[str, list[Bit]] = {f"{p}{k}": [bit] for p, w in wide.items() for k, bit in enumerate(w)}
        inputs |= {"SIGNEDA": ["0"], "SIGNEDB": ["0"]}
        outs: list[Bit] = [next(self._nets) for _ in range(36)]
        self._add("MULT18X18D", {}, inputs, {f"P{k}": [bit] for k, bit in enumerate(outs)})
        return outs

    def _add(self, kind: str, parameters: Any, inputs: Any, outputs: Any) -> None:
        self._cells[f"{kind.lower()}_{len(self._cells)}"] = {
            "type": kind,
            "parameters": parameters,
            "port_directions": dict.fromkeys(inputs, "input") | dict.fromkeys(outputs, "output"),
            "connections": inputs | outputs,
        }

    @property
    def netlist(self) -> Netlist:
        return {"modules": {TOP: {"ports": self._ports, "cells": self._cells, "netnames": {}}}}


def outputs(
    netlist: Netlist, inputs: dict[str, NDArray[np.int64]] | None = None
) -> dict[str, NDArray[np.int64]]:
    """What a netlist of LUT4 and CCU2C puts out, for given columns of inputs or for all that there are.

    The cells' semantics are those of yosys' models. Fails where a net that is read has no driver.
    """
    module = netlist["modules"][TOP]
    ports = module["ports"]
    names = [name for name, port in ports.items() if port["direction"] == "input"]
    if inputs is None:
        ranges = [range(1 << len(ports[name]["bits"])) for name in names]
        inputs = dict(zip(names, np.array(list(product(*ranges))).T, strict=True))
    nets: dict[Bit, Column] = {
        bit: (inputs[name] >> k & 1).astype(np.uint8)
        for name in names
        for k, bit in enumerate(ports[name]["bits"])
    }
    rows = len(next(iter(inputs.values())))
    nets |= {"0": np.zeros(rows, np.uint8), "1": np.ones(rows, np.uint8)}
    drivers = {
        bit: cell
        for cell in module["cells"].values()
        for port, bits in cell["connections"].items()
        if cell["port_directions"][port] == "output"
        for bit in bits
    }

    def value(bit: Bit) -> Column:
        if bit not in nets:
            evaluate(drivers[bit])
        return nets[bit]

    def evaluate(cell: dict[str, Any]) -> None:
        pin = {port: bits[0] for port, bits in cell["connections"].items()}
        if cell["type"] == "LUT4":
            nets[pin["Z"]] = table(cell["parameters"]["INIT"], [value(pin[p]) for p in PINS if p in pin])
            return
        assert cell["type"] == "CCU2C", cell["type"]
        carry = value(pin["CIN"])
        for half in "01":
            init, whole = cell["parameters"][f"INIT{half}"], cell["parameters"][f"INJECT1_{half}"] == "NO"
            lines = [value(pin[p + half]) for p in PINS]
            propagate = table(init, lines)
            nets[pin[f"S{half}"]] = propagate ^ (carry & whole)
            carry = np.where(propagate, carry, table(init, lines[:2]) & whole).astype(np.uint8)
        nets[pin["COUT"]] = carry

    for bit, cell in drivers.items():
        if bit not in nets and cell["type"] == "CCU2C":
            value(cell["connections"]["CIN"][0])  # chains from their beginning: no deep recursion
    return {
        name: sum(value(bit).astype(np.int64) << k for k, bit in enumerate(port["bits"]))
        for name, port in ports.items()
        if port["direction"] == "output"
    }


def table(init: str, lines: list[Column]) -> Column:
    """A lookup table's output; the first line is the lowest bit of its address."""
    address = sum(line.astype(np.int64) << k for k, line in enumerate(lines))
    return np.array([int(bit) for bit in reversed(init)], np.uint8)[address]
