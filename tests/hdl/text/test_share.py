"""Equal modules become one, different ones do not, and the design stays what it was."""

import re

import pytest
from amaranth.back import rtlil
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.flow.limits import taken
from softdepth.flow.synthesis import TOP, core_netlist, synthesise
from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.collisions import waive_collisions
from softdepth.hdl.text.share import share
from softdepth.spec.config import Config
from softdepth.spec.errors import ToolError


class Step(wiring.Component):
    """Adds a constant to its input, in a module of its own below; names differ from one to the next."""

    def __init__(self, amount: int, name: str, init: int = 0) -> None:
        self._amount, self._name, self._init = amount, name, init
        super().__init__({"i": In(8), "o": Out(8)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules[f"inner_{self._name}"] = inner = Module()
        held = Signal(8, name=f"held_{self._name}", init=self._init)
        inner.d.sync += held.eq(self.i + self._amount)
        m.d.comb += self.o.eq(held)
        return m


class Steps(wiring.Component):
    """Several steps side by side."""

    def __init__(self, *steps: Step) -> None:
        self._steps = steps
        super().__init__({"i": In(8 * len(steps)), "o": Out(8 * len(steps))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for k, step in enumerate(self._steps):
            m.submodules[f"step_{k}"] = step
            m.d.comb += [
                step.i.eq(self.i.word_select(k, 8)),
                self.o.word_select(k, 8).eq(step.o),
            ]
        return m


def shared(*steps: Step, smallest: int = 1) -> str:
    return share(rtlil.convert(Steps(*steps), name=TOP, emit_src=False), smallest=smallest)


def modules(text: str) -> list[str]:
    return re.findall(r"^module (\S+)", text, re.MULTILINE)


def kept(text: str) -> list[str]:
    return re.findall(r"keep_hierarchy 1\n(?:attribute .*\n)*module (\S+)", text)


def test_equal_modules_with_other_names_become_one():
    text = shared(Step(3, "a"), Step(3, "b"), Step(3, "c"))
    assert modules(text) == ["\\top.step_0.inner_a", "\\top.step_0", "\\top"]
    assert re.findall(r"^  cell \\top\.step_0 (\S+)", text, re.MULTILINE) == [
        "\\step_0",
        "\\step_1",
        "\\step_2",
    ]


@pytest.mark.parametrize("other", [Step(4, "b"), Step(3, "b", init=1)])
def test_modules_that_differ_in_a_constant_stay_apart(other):
    text = shared(Step(3, "a"), other)
    assert len(modules(text)) == 5


def test_only_the_outermost_of_several_instances_is_kept():
    assert kept(shared(Step(3, "a"), Step(3, "b"))) == ["\\top.step_0"]
    assert kept(shared(Step(3, "a"), Step(4, "b"))) == []


def test_small_modules_are_left_to_be_flattened():
    assert kept(shared(Step(3, "a"), Step(3, "b"), smallest=100)) == []


def test_ports_follow_the_module_that_stays():
    """Amaranth names ports after signals outside: a cell must use the names of the module that stays."""
    config = Config.preset("sad").override(["disparities=8", "lanes=4", "max_width=16", "max_height=16"])
    text = share(rtlil.convert(StereoCore(config), name=TOP, emit_src=False), smallest=1)
    ports = {
        name: set(re.findall(r"^  wire .*(?:input|output) \d+ .*?(\S+)$", body, re.MULTILINE))
        for name, body in re.findall(r"^module (\S+)\n(.*?)^end\n", text, re.MULTILINE | re.DOTALL)
    }
    cells = re.findall(r"^  cell (\\top\S*) \S+\n(.*?)^  end\n", text, re.MULTILINE | re.DOTALL)
    assert len(cells) > 10
    for name, body in cells:
        assert set(re.findall(r"^    connect (\S+)", body, re.MULTILINE)) == ports[name]


def test_a_design_without_a_top_is_refused():
    with pytest.raises(ToolError, match="no top module"):
        share("module \\a\nend\n")


@pytest.mark.slow
def test_the_area_is_that_of_the_design_as_it_was(tmp_path):
    config = Config.preset("lite").override(["disparities=8", "lanes=4", "max_width=64", "max_height=64"])
    design = waive_collisions(rtlil.convert(StereoCore(config), name=TOP, emit_src=False))
    apart = taken(synthesise(design, "ecp5", tmp_path))
    together = taken(core_netlist(config))
    assert together["ebr"] == apart["ebr"]
    # Registers on the way to every lane are alike. Apart, yosys makes one of them for all lanes.
    for resource, tolerance in (("lut4", 0.06), ("ff", 0.1)):
        assert together[resource] == pytest.approx(apart[resource], rel=tolerance), resource
