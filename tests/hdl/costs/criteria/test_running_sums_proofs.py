"""Running sums, proven at small widths: what is told of a column is the sum of what came and went there."""

from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Array, Assert, Assume, Module, Mux, Signal
from amaranth.lib.wiring import Component, In

from softdepth.hdl.costs.criteria.running_sums import RunningSums
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import late, some_clocks

pytestmark = pytest.mark.formal

LARGEST, MOST, APART = 3, 7, 6
CLOCKS = 60


SUMS = Claim(
    "a running sum is the sum of what entered its column minus what left it, from the frame's first row on",
    sizes=f"{APART} places, sums of 3 bits",
    depth=f"{CLOCKS} clocks",
)


class Summed(Component):
    """`RunningSums` beside a sum of each place: places go round, with pauses, and frames begin at any row."""

    valid: In(1)
    begins: In(1)
    outside: In(1)
    new: In(range(LARGEST + 1))
    old: In(range(LARGEST + 1))

    def __init__(self, block: Any) -> None:
        self._sums = block([MOST], [LARGEST], APART)
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.sums = sums = self._sums
        place = Signal(range(APART))
        first = Signal(init=1)  # the memory holds nothing yet
        begins = Signal()
        new, old = Signal.like(self.new), Signal.like(self.old)
        m.d.comb += [
            begins.eq(self.begins | first),
            sums.valid.eq(self.valid),
            sums.place.eq(place),
            sums.begins.eq(begins),
            sums.outside.eq(self.outside),
            new.eq(self.new),
            old.eq(self.old),
            sums.new["0"].eq(late(m, new, sums.ahead, "new")),
            sums.old["0"].eq(late(m, old, sums.ahead, "old")),
        ]
        kept = [Signal(range(MOST + 1), name=f"kept_{k}") for k in range(APART)]
        known = Signal(APART)
        here = Array(kept)[place]
        total = Signal(range(-LARGEST, MOST + LARGEST + 1))
        m.d.comb += [
            total.eq(Mux(begins | ~known.bit_select(place, 1), 0, here) + new - old),
            # What leaves was there, and a sum is as wide as it must be; a place begins before it goes on.
            Assume(self.outside | ((total >= 0) & (total <= MOST))),
            Assume(~self.valid | self.outside | begins | known.bit_select(place, 1)),
        ]
        with m.If(self.valid):
            m.d.sync += place.eq(Mux(place == APART - 1, 0, place + 1))
            with m.If(place == APART - 1):
                m.d.sync += first.eq(0)
            with m.If(~self.outside):
                m.d.sync += [here.eq(total), known.bit_select(place, 1).eq(1)]
        due = late(m, self.valid, sums.latency, "due")
        expected = Signal(range(MOST + 1))
        m.d.comb += expected.eq(Mux(self.outside, 0, total))
        m.d.comb += Assert(~due | (sums.o["0"] == late(m, expected, sums.latency, "expected")))
        return m


@SUMS.proven
def test_a_running_sum_is_the_sum_of_what_came_less_what_went(tmp_path: Path) -> None:
    dut = Summed(RunningSums)
    assert some_clocks(dut, tmp_path, CLOCKS) == "runs of some clocks"


FAULTS = {
    "a frame begins at no zero": ("before.eq(Mux(begins[3], 0, read[name]))", "before.eq(read[name])"),
    "written at another place": ("memory.write_at.eq(place[5])", "memory.write_at.eq(place[4])"),
}


@SUMS.refuted
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_refuted(fault: str, tmp_path: Path) -> None:
    broken = mutated(RunningSums, *FAULTS[fault])
    assert some_clocks(Summed(broken), tmp_path, CLOCKS) == "refuted"
