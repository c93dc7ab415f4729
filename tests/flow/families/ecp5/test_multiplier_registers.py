"""Which flip-flops go into a multiplier, and which must stay where they are.

That the result is the same circuit is for the netlist's simulation to show.
"""

from typing import Any

import pytest

from softdepth.flow.families.ecp5.multiplier_registers import absorb_multiplier_registers
from tests.flow.circuits import Bit, Circuit

WIDTH = 5


class Multiplier:
    """A product of two words between registers, of which the caller may spoil some."""

    def __init__(self) -> None:
        self.circuit = c = Circuit()
        (self.clock,), (self.other,) = c.input("clk", 1), c.input("other", 1)
        self.a, self.b = c.input("a", WIDTH), c.input("b", WIDTH)

    def build(self, *, enables: tuple[Bit, Bit, Bit] = ("1", "1", "1"), reset: Bit = "0") -> list[Bit]:
        """The registered product; enables of a, b and the product; the reset of one bit of each."""
        c = self.circuit
        self.registers = [
            [c.register(bit, self.clock, enable, reset if k == 0 else "0") for k, bit in enumerate(word)]
            for word, enable in zip((self.a, self.b), enables[:2], strict=True)
        ]
        self.product = c.multiply(*self.registers)[: 2 * WIDTH]
        out = [
            c.register(bit, self.clock, enables[2], reset if k == 0 else "0")
            for k, bit in enumerate(self.product)
        ]
        c.output("o", out)
        return out

    def absorb(self) -> tuple[int, dict[str, Any]]:
        """How many flip-flops went, and the multiplier's cell."""
        netlist = self.circuit.netlist
        before = self.flip_flops
        gone = absorb_multiplier_registers(netlist)
        assert before - self.flip_flops == gone
        (cell,) = (c for c in self._cells if c["type"] == "MULT18X18D")
        return gone, cell

    @property
    def flip_flops(self) -> int:
        return sum(cell["type"] == "TRELLIS_FF" for cell in self._cells)

    @property
    def _cells(self) -> list[dict[str, Any]]:
        (module,) = self.circuit.netlist["modules"].values()
        return list(module["cells"].values())


def registered(cell: dict[str, Any]) -> set[str]:
    return {key.split("_")[1] for key in cell["parameters"] if key.endswith("_CLK")}


def test_both_sides_go():
    m = Multiplier()
    out = m.build()
    gone, cell = m.absorb()
    assert gone == 4 * WIDTH
    assert registered(cell) == {"INPUTA", "INPUTB", "OUTPUT"}
    pins = cell["connections"]
    assert [pins[f"A{k}"] for k in range(18)] == [[bit] for bit in [*m.a, *["0"] * (18 - WIDTH)]]
    assert [pins[f"B{k}"] for k in range(WIDTH)] == [[bit] for bit in m.b]
    assert [pins[f"P{k}"] for k in range(2 * WIDTH)] == [[bit] for bit in out]
    assert pins["CLK0"] == [m.clock]


def test_registers_that_others_read_stay_for_them():
    m = Multiplier()
    m.build()
    m.circuit.output("seen", m.registers[0])
    gone, cell = m.absorb()
    assert gone == 3 * WIDTH
    assert [cell["connections"][f"A{k}"] for k in range(WIDTH)] == [[bit] for bit in m.a]


def test_clock_enables_go_along():
    m = Multiplier()
    m.build(enables=(m.other, m.other, "1"))
    gone, cell = m.absorb()
    assert gone == 4 * WIDTH
    for register, enable in (("INPUTA", [m.other]), ("INPUTB", [m.other]), ("OUTPUT", ["1"])):
        assert cell["connections"][cell["parameters"][f"REG_{register}_CE"]] == enable


@pytest.mark.parametrize(
    "what", ["enables differ", "a reset", "an operand without register", "another clock"]
)
def test_operands_stay(what: str):
    m = Multiplier()
    if what == "enables differ":
        m.build(enables=(m.other, "1", "1"))
    elif what == "a reset":
        m.build(reset=m.other)
    elif what == "an operand without register":
        c = m.circuit
        m.product = c.multiply([c.register(bit, m.clock) for bit in m.a], m.b)
        c.output("o", m.product)
    else:
        c = m.circuit
        words = [[c.register(bit, clock) for bit in word] for word, clock in ((m.a, m.clock), (m.b, m.other))]
        c.output("o", c.multiply(*words))
    _, cell = m.absorb()
    assert not registered(cell) & {"INPUTA", "INPUTB"}
    assert [cell["connections"][f"A{k}"] for k in range(WIDTH)] != [[bit] for bit in m.a]


@pytest.mark.parametrize("what", ["read directly", "a reset", "an output of the design"])
def test_products_stay(what: str):
    m = Multiplier()
    m.build(reset=m.other if what == "a reset" else "0")
    if what == "read directly":
        m.circuit.output("seen", [m.circuit.lut(0x5555, m.product[3])])
    elif what == "an output of the design":
        m.circuit.output("seen", [m.product[0]])
    gone, cell = m.absorb()
    assert "OUTPUT" not in registered(cell)
    assert gone == (0 if what == "a reset" else 2 * WIDTH)


def test_the_product_of_another_clock_stays():
    m = Multiplier()
    c = m.circuit
    product = c.multiply(*([c.register(bit, m.clock) for bit in word] for word in (m.a, m.b)))
    c.output("o", [c.register(bit, m.other) for bit in product])
    gone, cell = m.absorb()
    assert (gone, registered(cell)) == (2 * WIDTH, {"INPUTA", "INPUTB"})
