"""Proofs by yosys' own solver: streams keep their contract, whatever comes and whenever it is taken.

A property holds of every run (induction), or of every run of some clocks from reset on; each is
shown to fail on a block with a fault.
"""

from pathlib import Path
from typing import Literal

import pytest
from amaranth.hdl import Assert, Module, Signal, Value
from amaranth.lib import data, stream
from amaranth.lib.wiring import Component, In

from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.result_queue import ResultQueue
from tests.support.claims import Claim
from tests.support.proofs import every_run, late, pipeline_proof, proof

pytestmark = pytest.mark.formal

BITS = 2
LATENCY = 1
Fault = Literal["none", "waits for ready", "withdraws", "changes"]
FAULTS: tuple[Fault, ...] = ("waits for ready", "withdraws", "changes")


OFFERS = Claim(
    "what a queue offers stays unchanged until it is taken: the input's item queue, and the result queue at"
    " the end of a pipeline",
    sizes=f"{BITS} bits",
    depth="every run",
)
ITEMS = Claim(
    "the item queue neither loses, doubles nor reorders",
    sizes="one place or two, 16 items told apart",
    depth="every run",
)


class Watched(Component):
    """A block whose output stream is watched: what is on offer stands until it is taken, unchanged."""

    valid: In(1)
    payload: In(BITS)
    ready: In(1)

    def __init__(self, block: Component, fault: Fault) -> None:
        self._block, self._fault = block, fault
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.block = block = self._block
        if isinstance(block, ResultQueue):
            # As it is used: a result is promised where there is credit, and comes so many clocks later.
            promised = Signal()
            late = Signal(LATENCY)
            m.d.comb += [
                promised.eq(self.valid & block.credit),
                block.promised.eq(promised),
                block.put.eq(late[-1]),
                Value.cast(block.result).eq(self.payload),
            ]
            m.d.sync += late.eq((late << 1) | promised)
        else:
            m.d.comb += [block.i.valid.eq(self.valid), block.i.payload.eq(self.payload)]
        o = stream.Signature(BITS).create()
        m.d.comb += [
            o.ready.eq(self.ready),
            o.valid.eq(block.o.valid),
            o.payload.eq(Value.cast(block.o.payload)),
        ]
        m.d.comb += block.o.ready.eq(o.ready)
        match self._fault:
            case "waits for ready":
                m.d.comb += o.valid.eq(block.o.valid & self.ready)
            case "withdraws":
                m.d.comb += o.valid.eq(block.o.valid & ~(self.valid & self.payload.all()))
            case "changes":
                m.d.comb += o.payload.eq(Value.cast(block.o.payload) ^ self.payload)
        waited = Signal()
        before = Signal(BITS)
        offered = Signal()  # it would be, were it taken
        m.d.comb += offered.eq(o.valid)
        m.d.sync += [waited.eq(block.o.valid & ~o.ready), before.eq(o.payload)]
        with m.If(waited):
            m.d.comb += Assert(offered & (o.payload == before))
        return m


BLOCKS = {
    "item queue": lambda: ItemQueue(BITS),
    "item queue of one place": lambda: ItemQueue(BITS, places=1),
    "result queue": lambda: ResultQueue(data.StructLayout({"word": BITS}), LATENCY),
}


@OFFERS.proven
@pytest.mark.parametrize("name", BLOCKS)
def test_what_is_on_offer_stands_unchanged_until_it_is_taken(name: str, tmp_path: Path) -> None:
    assert proof(Watched(BLOCKS[name](), "none"), tmp_path) == "every run"


@OFFERS.refuted
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", BLOCKS)
def test_a_fault_is_refuted(name: str, fault: Fault, tmp_path: Path) -> None:
    assert proof(Watched(BLOCKS[name](), fault), tmp_path) == "refuted"


class Ordered(Component):
    """`ItemQueue` beside a plain count: all items leave but those in its places, and in their order."""

    valid: In(1)
    ready: In(1)

    def __init__(self, places: int, *, lost: bool) -> None:
        self._places, self._lost = places, lost
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.queue = queue = ItemQueue(4, places=self._places)
        sent, got = Signal(4), Signal(4)
        taken = Signal()
        m.d.comb += [
            queue.i.valid.eq(self.valid),
            queue.i.payload.eq(sent),
            queue.o.ready.eq(self.ready),
            taken.eq(self.valid & (True if self._lost else queue.i.ready)),
            Assert((sent - got)[:4] <= self._places),
            Assert(queue.o.valid == (sent != got)),
            Assert(queue.i.ready == ((sent - got)[:4] != self._places)),
        ]
        with m.If(taken):
            m.d.sync += sent.eq(sent + 1)
        with m.If(queue.o.valid & self.ready):
            m.d.comb += Assert(queue.o.payload == got)
            m.d.sync += got.eq(got + 1)
        return m


@ITEMS.proven
@pytest.mark.parametrize("places", [1, 2])
def test_items_are_neither_lost_nor_doubled(places: int, tmp_path: Path) -> None:
    assert every_run(Ordered(places, lost=False), tmp_path) == "every run"


@ITEMS.refuted
@pytest.mark.parametrize("places", [1, 2])
def test_a_queue_that_is_overrun_is_refuted(places: int, tmp_path: Path) -> None:
    assert proof(Ordered(places, lost=True), tmp_path) == "refuted"


class Remembering(Component):
    """A pipeline of two clocks; with a fault, it goes wrong once in 1024 clocks."""

    i: In(BITS)
    latency = 2

    def __init__(self, wrong: bool) -> None:
        self._wrong = wrong
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count = Signal(10)
        m.d.sync += count.eq(count + 1)
        o = Signal(BITS)
        m.d.comb += o.eq(late(m, self.i, self.latency, "o") ^ (count.all() & self._wrong))
        m.d.comb += Assert(o == late(m, self.i, self.latency, "expected"))
        return m


def test_a_pipeline_is_proven_from_any_state(tmp_path: Path) -> None:
    assert pipeline_proof(Remembering(wrong=False), tmp_path, Remembering.latency) == "every run"
    assert pipeline_proof(Remembering(wrong=True), tmp_path, Remembering.latency) == "refuted"
