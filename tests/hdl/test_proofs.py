"""Proofs by yosys' own solver: streams keep their contract, whatever comes and whenever it is taken.

A property holds of every run (induction), or of every run of some clocks from reset on; each is
shown to fail on a block with a fault.
"""

from pathlib import Path
from typing import Any, Literal

import pytest
from amaranth.hdl import Assert, Module, Signal, Value
from amaranth.lib import data, stream
from amaranth.lib.wiring import Component, In

from softdepth.hdl.front.item_queue import ItemQueue
from softdepth.hdl.memory.level import Level
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY, ResultQueue
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import every_run, late, pipeline_proof, proof, some_clocks

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
PROMISES = Claim(
    "the result queue has a place for everything that is promised: nothing is lost, doubled or reordered,"
    " even if promises are dropped",
    sizes=f"a pipeline of {LATENCY} clock, near the queue or a clock away, 32 results told apart",
    depth="14 clocks; of one near the queue every run with `make formal`",
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


class Promised(Component):
    """`ResultQueue` behind a pipeline: what is promised and not dropped leaves, all of it and in order.

    If it is ``far``, credit and promises take a clock each for their way.
    """

    valid: In(1)
    drop: In(1)
    ready: In(1)

    def __init__(self, wrong: bool = False, *, far: bool = False, unseen: int = 0) -> None:
        self._wrong, self._far, self._unseen = wrong, far, unseen
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        queue = ResultQueue(data.StructLayout({"word": 5}), LATENCY, unseen=self._unseen)
        m.submodules.queue = queue
        promised, due = Signal(), Signal(LATENCY)
        sent, got = Signal(5), Signal(5)
        m.d.comb += [
            promised.eq(self.valid & (True if self._wrong else late(m, queue.credit, self._far, "credit"))),
            queue.promised.eq(late(m, promised, self._far, "promised")),
            queue.put.eq(due[-1] & ~self.drop),
            queue.dropped.eq(due[-1] & self.drop),
            queue.result.word.eq(sent),
            queue.o.ready.eq(self.ready),
        ]
        m.d.sync += due.eq((due << 1) | promised)
        with m.If(queue.put):
            m.d.sync += sent.eq(sent + 1)
        with m.If(queue.o.valid):
            m.d.comb += Assert((queue.o.payload.word == got) & (sent != got))
            with m.If(self.ready):
                m.d.sync += got.eq(got + 1)
        m.d.comb += Assert((sent - got)[:5] <= LATENCY + QUEUE_LATENCY + 2 + self._unseen)
        return m


@PROMISES.proven
@pytest.mark.parametrize(("far", "unseen"), [(False, 0), (True, 2)])
def test_promised_results_have_their_places(far: bool, unseen: int, tmp_path: Path) -> None:
    dut = Promised(far=far, unseen=unseen)
    assert some_clocks(dut, tmp_path, 14) == "runs of some clocks"


@PROMISES.proven
@pytest.mark.full
def test_promised_results_have_their_places_in_every_run(tmp_path: Path) -> None:
    assert every_run(Promised(), tmp_path) == "every run"


UNKEPT: dict[str, dict[str, Any]] = {
    "promises need no credit": {"wrong": True},
    "credit that is far is taken to be near": {"far": True, "unseen": 0},
}


@PROMISES.refuted
@pytest.mark.parametrize("fault", UNKEPT)
def test_promises_without_places_are_refuted(fault: str, tmp_path: Path) -> None:
    assert proof(Promised(**UNKEPT[fault]), tmp_path) == "refuted"


DEEP = 40
"""Clocks of a pipeline that is as long as a core's."""
TOLD = (
    "some = Level(m, places, self.put, moves).some",
    "level = Level(m, places, self.put, moves)\n        some = level.some",
    "m.d.comb += [counted.eq(left + back), self.credit.eq(credit)]",
    "m.d.comb += [counted.eq(left + back), self.credit.eq(credit), self.left.eq(left),"
    " self.words.eq(level.held), self.some.eq(some), self.told.eq(left + back + level.held + holding),"
    " self.overflows.eq(self.put & (level.held == places) & ~moves)]",
)
HELD = ("held = Signal(range(most + 1)", "self.held = held = Signal(range(most + 1)")
"""What the queue's text says besides, to be looked at."""

OVERFLOWS = Claim(
    "no place of a result queue is lost or promised twice: places that are left, waited for and taken are"
    " all that"
    " there are, whatever is dropped; and nothing is put into a full queue",
    sizes=f"a queue for a pipeline of {DEEP} clocks, whose results come whenever they do",
    depth="every run",
)


class Accounted(Component):
    """`ResultQueue` with the count of its places; what was promised comes, or is dropped, at any time."""

    valid: In(1)
    comes: In(1)
    drop: In(1)
    ready: In(1)

    def __init__(self, *fault: str) -> None:
        block = mutated(ResultQueue, *TOLD, *fault)
        block.elaborate.__globals__["Level"] = mutated(Level, *HELD)
        self._queue = block(data.StructLayout({"word": 1}), DEEP)
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.queue = queue = self._queue
        depth = DEEP + QUEUE_LATENCY + 2
        queue.left, queue.words = left, words = Signal(range(depth + 1)), Signal(range(depth + 1))
        queue.told, queue.overflows = told, overflows = Signal(range(8 * depth)), Signal()
        queue.some = some = Signal()
        waiting = Signal(range(2 * depth))
        promised, comes = Signal(), Signal()
        m.d.comb += [
            promised.eq(self.valid & queue.credit),
            comes.eq(self.comes & (waiting != 0)),
            queue.promised.eq(promised),
            queue.put.eq(comes & ~self.drop),
            queue.dropped.eq(comes & self.drop),
            queue.o.ready.eq(self.ready),
            Assert(told + waiting == depth),
            Assert(~overflows),
            # What keeps the induction to states that there are.
            Assert(queue.credit == (left != 0)),
            Assert(some == (words != 0)),
            Assert(queue.o.valid | (words <= 1)),
        ]
        m.d.sync += waiting.eq(waiting + promised - comes)
        return m


@OVERFLOWS.proven
def test_a_long_pipeline_never_overflows_its_queue(tmp_path: Path) -> None:
    assert proof(Accounted(), tmp_path, clocks=4) == "every run"


PLACES = {
    "a dropped place is lost": ("back.eq(self.dropped + taken)", "back.eq(taken)"),
    "a place comes back too soon": ("back.eq(self.dropped + taken)", "back.eq(self.dropped + holding)"),
    "a promise takes no place": ("left.eq(Mux(self.promised, counted - 1, counted))", "left.eq(counted)"),
}


@OVERFLOWS.refuted
@pytest.mark.parametrize("fault", PLACES)
def test_a_queue_that_miscounts_is_refuted(fault: str, tmp_path: Path) -> None:
    assert proof(Accounted(*PLACES[fault]), tmp_path, clocks=6) == "refuted"


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
