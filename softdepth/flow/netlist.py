"""A netlist as yosys writes it."""

from typing import Any

Netlist = dict[str, Any]
"""A design as yosys writes it in JSON."""

Cell = dict[str, Any]

Bit = int | str
"""A net's number, or a constant: "0", "1", "x", "z"."""
