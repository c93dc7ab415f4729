"""Verilog: the documented ports, for every operator; memories in few lines."""

import re

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.verilog import TOP, to_verilog
from softdepth.spec.config import OPERATORS, Config
from tests.support.simulation import config, sad


def ports(verilog: str, top: str) -> dict[str, tuple[str, int]]:
    """Direction and width of the top module's ports."""
    (body,) = re.findall(rf"^module {top}\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)
    found = re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+) ?;", body, re.MULTILINE)
    return {name: (direction, int(high or 0) + 1) for direction, high, name in found}


@pytest.mark.parametrize(("disparities", "bits"), [(4, 2), (5, 3)])
def test_ports_are_as_documented(disparities: int, bits: int) -> None:
    c = config(cost="sum", criteria=[sad(3)], disparities=disparities, lanes=1)
    assert ports(to_verilog(c), TOP) == {
        "clk": ("input", 1),
        "rst": ("input", 1),
        "i__payload": ("input", 24 + 24 + 3),
        "i__valid": ("input", 1),
        "i__ready": ("output", 1),
        "o__payload": ("output", bits + 2 + 4),
        "o__valid": ("output", 1),
        "o__ready": ("input", 1),
        "status": ("output", 4 * 16),
    }


def test_any_component_by_any_name() -> None:
    text = to_verilog(Delay(3, 2), name="late")
    assert ports(text, "late") == {
        "clk": ("input", 1),
        "rst": ("input", 1),
        "en": ("input", 1),
        "i": ("input", 3),
        "o": ("output", 3),
    }


def test_text_depends_on_the_configuration_only() -> None:
    c = config(cost="sum", criteria=[sad(3)], disparities=4, lanes=2)
    assert to_verilog(c) == to_verilog(Config.from_dict(c.model_dump(mode="json")))


@pytest.mark.parametrize("operator", OPERATORS)
def test_every_operator_has_gateware(operator: str) -> None:
    c = config(criteria=[sad(3, dx) for dx in (-1, 0, 1)], disparities=2, lanes=1, operator=operator)
    assert ports(to_verilog(c), TOP)["o__payload"] == ("output", 1 + 2 + 4)


def stored(words: list[int], width: int = 4) -> str:
    """Verilog of a memory with these initial words."""

    class Stored(wiring.Component):
        at: In(range(len(words)))
        o: Out(width)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.words = memory = Memory(shape=width, depth=len(words), init=words)
            write, read = memory.write_port(), memory.read_port()
            m.d.comb += [
                write.en.eq(self.at[0]),
                write.data.eq(self.o),
                read.addr.eq(self.at),
                self.o.eq(read.data),
            ]
            return m

    return to_verilog(Stored(), name="stored")


@pytest.mark.parametrize("words", [2, 3, 1000])
def test_memories_are_cleared_by_a_loop(words: int) -> None:
    """All words, and without a line for each."""
    text = stored([0] * words)
    (loop,) = re.findall(r"initial begin : (\w+)\n.*?\n  end\n", text, re.DOTALL)
    (memory,) = re.findall(rf"reg \[3:0\] (\w+) \[{words - 1}:0\];", text)
    assert loop == f"clear_{memory}"
    assert f"for (k = 0; k < {words}; k = k + 1)\n      {memory}[k] = 4'h0;\n" in text
    assert not re.search(rf"{memory}\[\d+\] =", text)


@pytest.mark.parametrize("words", [[0, 0, 5], [5, 0, 0], [0, 5, 0], [7, 7, 7]])
def test_other_initial_words_stay(words: list[int]) -> None:
    text = stored(words)
    assert "for (" not in text
    assert [int(w, 16) for w in re.findall(r"\w+\[\d+\] = 4'h(\w);", text)] == words
