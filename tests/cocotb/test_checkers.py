"""The checkers work: gateware with one deliberate fault each is caught."""

from collections.abc import Callable

import pytest
from amaranth.hdl import Module, ShapeLike
from amaranth.lib import wiring

from softdepth.hdl.costs import band_costs, cost
from softdepth.hdl.costs.criteria import column_sad, row_memory
from softdepth.hdl.costs.fuzzy import cell_inference, mean_inference, rule_array
from softdepth.hdl.front import line_buffer
from softdepth.hdl.memory import result_queue
from softdepth.hdl.verilog import to_verilog
from softdepth.hdl.winners import band_winners
from softdepth.sim.stalls import Pauses, Stalls
from softdepth.spec import rules
from softdepth.spec.config import Config
from softdepth.spec.errors import ToolError
from tests.cocotb.conftest import Exact
from tests.cocotb.scenes import frames_for

CONFIG = Config.preset("paper").override(["disparities=8", "lanes=4"])
RULES = CONFIG.override(["operator=soft_min_1", "firing=all"])
"""With the rule array, which only the soft minima over all rules have need of."""
CELL = CONFIG.override(["operator=min", "criteria.1.label_bits=11"])
"""With the rules of a cell, and criteria in the cells where the two tables differ."""
STALLS = Stalls(output=Pauses("bursts", probability=0.5, burst=100, seed=5))


def break_a_rule(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rules 222 (conclusion 6) and 113 (conclusion 9) change places."""
    broken = {k: list(r) for k, r in rules.rule_base(CONFIG.rules).items()}
    broken[6][broken[6].index((2, 2, 2))] = (1, 1, 3)
    broken[9][broken[9].index((1, 1, 3))] = (2, 2, 2)
    monkeypatch.setattr(rule_array, "rule_base", lambda name: broken)


def correct_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rules of a cell are the corrected table's, where the printed one is configured."""
    monkeypatch.setattr(cell_inference, "joins_corners", lambda name: False)


def shift_the_line_buffer(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line buffer is off by one: its columns end a line above the pixel."""

    class Shifted(line_buffer.LineBuffer):
        def __init__(self, width: int, rows: int, max_width: int) -> None:
            super().__init__(width, rows, max_width)
            self.inner = line_buffer.LineBuffer(width, rows + 1, max_width)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.inner = inner = self.inner
            m.d.comb += [inner.en.eq(self.en), inner.x.eq(self.x), inner.pixel.eq(self.pixel)]
            m.d.comb += [row.eq(inner.column[k]) for k, row in enumerate(self.column)]
            return m

    monkeypatch.setattr(band_costs, "LineBuffer", Shifted)


def drop_under_back_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    """The result queue forgets a result, and its place is free again, where no more are promised or read."""

    class Leaky(result_queue.ResultQueue):
        def __init__(self, shape: ShapeLike, latency: int, *, unseen: int) -> None:
            super().__init__(shape, latency, unseen=unseen)
            self.inner = result_queue.ResultQueue(shape, latency, unseen=unseen)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.inner = inner = self.inner
            wiring.connect(m, inner.o, wiring.flipped(self.o))
            lost = self.put & ~inner.credit & ~self.o.ready
            m.d.comb += [
                self.credit.eq(inner.credit),
                inner.promised.eq(self.promised),
                inner.put.eq(self.put & ~lost),
                inner.dropped.eq(lost),
                inner.result.eq(self.result),
            ]
            return m

    monkeypatch.setattr(band_winners, "ResultQueue", Leaky)


def take_rows_in_the_wrong_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The two remembered rows change places: sums over all rows are as before, those over fewer are not."""

    class Swapped(row_memory.RowMemory):
        def __init__(self, shape: ShapeLike, rows: int, places: int) -> None:
            super().__init__(shape, rows, places)
            self.inner = row_memory.RowMemory(shape, rows, places)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.inner = inner = self.inner
            m.d.comb += [inner.valid.eq(self.valid), inner.place.eq(self.place), inner.newest.eq(self.newest)]
            m.d.comb += [self.rows[k].eq(inner.rows[1 - k]) for k in range(2)]
            return m

    monkeypatch.setattr(column_sad, "RowMemory", Swapped)


def confuse_the_criteria(monkeypatch: pytest.MonkeyPatch) -> None:
    """MEAN's closed form is given criterion 3 as its second: which of them counts more is lost."""

    class Confused(cost.MeanInference):
        def __init__(self, config: Config, maxima: list[int]) -> None:
            super().__init__(config, maxima)
            self.inner = mean_inference.MeanInference(config, maxima)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.inner = inner = self.inner
            m.d.comb += [inner.i.s0.eq(self.i.s0), inner.i.s1.eq(self.i.s2), inner.i.s2.eq(self.i.s2)]
            m.d.comb += [self.num.eq(inner.num), self.den.eq(inner.den)]
            return m

    monkeypatch.setattr(cost, "MeanInference", Confused)


FAULTS: dict[Callable[[pytest.MonkeyPatch], None], tuple[Config, type[Exception], str]] = {
    break_a_rule: (RULES, AssertionError, "criteria or inference"),
    correct_the_table: (CELL, AssertionError, "criteria or inference"),
    confuse_the_criteria: (CONFIG, AssertionError, "criteria or inference"),
    take_rows_in_the_wrong_order: (CONFIG, AssertionError, "criteria, inference or argmin"),
    shift_the_line_buffer: (CONFIG, AssertionError, r"line buffer \(as of the line above\)"),
    drop_under_back_pressure: (CONFIG, ToolError, "results or sequencer"),
}
"""With the configuration that shows each, how it is told, and the stage that is named."""


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_fault_is_caught_and_its_stage_named(
    fault: Callable[[pytest.MonkeyPatch], None], exact: Exact, monkeypatch: pytest.MonkeyPatch
) -> None:
    config, error, stage = FAULTS[fault]
    pairs = frames_for(config, seed=1)
    sound = to_verilog(config)
    with monkeypatch.context() as patched:
        fault(patched)
        broken = to_verilog(config)
    assert broken != sound
    exact(config, pairs, verilog=sound, stalls=STALLS)
    with pytest.raises(error, match=f"stage: {stage}"):
        exact(config, pairs, verilog=broken, stalls=STALLS)
