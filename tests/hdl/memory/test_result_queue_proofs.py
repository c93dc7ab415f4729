"""Proofs of the result queue: it has a place for whatever it promised one, and miscounts none."""

from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Assert, Module, Signal
from amaranth.lib import data
from amaranth.lib.wiring import Component, In

from softdepth.hdl.memory.level import Level
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY, ResultQueue
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import every_run, late, proof, some_clocks

pytestmark = pytest.mark.formal

LATENCY = 1


PROMISES = Claim(
    "the result queue has a place for everything that is promised: nothing is lost, doubled or reordered,"
    " even if promises are dropped",
    sizes=f"a pipeline of {LATENCY} clock, 32 results told apart; its credit and its promises at once, its"
    " credit a clock late, or both",
    depth="14 clocks; of one near the queue every run with `make formal`",
)


class Promised(Component):
    """`ResultQueue` behind a pipeline: what is promised and not dropped leaves, all of it and in order.

    Credit and promises take so many clocks for their way.
    """

    valid: In(1)
    drop: In(1)
    ready: In(1)

    def __init__(self, wrong: bool = False, *, credit: int = 0, promises: int = 0, unseen: int = 0) -> None:
        self._wrong, self._credit, self._promises, self._unseen = wrong, credit, promises, unseen
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        queue = ResultQueue(data.StructLayout({"word": 5}), LATENCY, unseen=self._unseen)
        m.submodules.queue = queue
        promised, due = Signal(), Signal(LATENCY)
        sent, got = Signal(5), Signal(5)
        m.d.comb += [
            promised.eq(
                self.valid & (True if self._wrong else late(m, queue.credit, self._credit, "credit"))
            ),
            queue.promised.eq(late(m, promised, self._promises, "promised")),
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
@pytest.mark.parametrize(("credit", "promises"), [(0, 0), (1, 0), (1, 1)])
def test_promised_results_have_their_places(credit: int, promises: int, tmp_path: Path) -> None:
    dut = Promised(credit=credit, promises=promises, unseen=credit + promises)
    assert some_clocks(dut, tmp_path, 14) == "runs of some clocks"


@PROMISES.proven
@pytest.mark.full
def test_promised_results_have_their_places_in_every_run(tmp_path: Path) -> None:
    assert every_run(Promised(), tmp_path) == "every run"


UNKEPT: dict[str, dict[str, Any]] = {
    "promises need no credit": {"wrong": True},
    "late credit is taken to be of this clock": {"credit": 1},
    "late credit and promises are taken to be of this clock": {"credit": 1, "promises": 1},
    "late promises are forgotten": {"credit": 1, "promises": 1, "unseen": 1},
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
