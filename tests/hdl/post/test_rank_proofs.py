"""The median of what is kept, proven at small widths: as many samples lie on either side of it as must."""

from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Assert, Const, Module, Signal, Value
from amaranth.lib.wiring import Component, In

from softdepth.hdl.post.rank import LowerMedian
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import late, pipeline_proof

pytestmark = pytest.mark.formal

BITS = 3
MEDIAN = Claim(
    "the median of the medians and masked medians is the lower one of the samples that are kept, of any"
    " samples"
    " and any of them kept",
    sizes=f"5 samples of {BITS} bits with a mask, 9 of 2 without",
    depth="every run",
)


IN_REGISTERS = ("SOON = 4", "SOON = 16")
"""A delay in memory has an address, which has states that it never gets into."""


class Ranked(Component):
    """`LowerMedian` beside what a median is: so many lie below it at most, so many up to it at least."""

    def __init__(self, block: Any, samples: int, bits: int, masked: bool) -> None:
        self._median = block(samples, bits, all_kept=not masked)
        self._samples, self._bits, self._masked = samples, bits, masked
        self.latency = self._median.latency
        super().__init__({"values": In(samples * bits), "keep": In(samples)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.median = median = self._median
        m.d.comb += Value.cast(median.i).eq(self.values)
        keep = self.keep if self._masked else ~Signal(self._samples, name="none")
        if self._masked:
            m.d.comb += median.keep.eq(self.keep)
        values = late(m, self.values, self.latency, "values")
        kept = late(m, keep, self.latency, "kept")
        below = Signal(self._samples)
        up_to = Signal(self._samples)
        for k in range(self._samples):
            value = values.word_select(k, self._bits)
            m.d.comb += [
                below[k].eq(kept[k] & (value < median.o)),
                up_to[k].eq(kept[k] & (value <= median.o)),
            ]
        number, low, high = (sum(v, Const(0)) for v in (kept, below, up_to))
        rank = Signal(range(self._samples))
        m.d.comb += rank.eq((number - 1) >> 1)
        m.d.comb += Assert((number == 0) | ((low <= rank) & (high > rank)))
        return m


@MEDIAN.proven
@pytest.mark.parametrize(("samples", "bits", "masked"), [(5, BITS, True), (9, 2, False)])
def test_a_median_has_its_rank(samples: int, bits: int, masked: bool, tmp_path: Path) -> None:
    dut = Ranked(mutated(LowerMedian, *IN_REGISTERS), samples, bits, masked)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "every run"


FAULTS = {
    "the upper median": ("parts[0] + parts[1] - 1", "parts[0] + parts[1]"),
    "masked ones count": ("may & ~tops, f", "~tops, f"),
    "the rank stays": ("Mux(is_one, held_rank - zeros, held_rank)", "held_rank"),
}


@MEDIAN.refuted
@pytest.mark.parametrize("fault", FAULTS)
def test_a_median_with_a_fault_is_refuted(fault: str, tmp_path: Path) -> None:
    dut = Ranked(mutated(LowerMedian, *FAULTS[fault]), 5, 2, True)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "refuted"
