"""How the registers of a core with AXI streams are reached."""

from typing import Literal

Bus = Literal["axi-lite", "wishbone"]
