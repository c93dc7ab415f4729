"""Argmin, proven at small widths: the smallest fraction, of equal ones the smallest index.

Fractions are stated by their rank among all that the widths allow, so that nothing is multiplied here.
"""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Assert, Cat, Const, Module, Mux, Shape, Signal, Value, unsigned
from amaranth.lib import data
from amaranth.lib.wiring import Component, In

from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import every_run, late, looked_up, pipeline_proof, some_clocks

pytestmark = pytest.mark.formal

NUM, DEN, NO_DEN = range(-4, 4), range(4), unsigned(0)
INDICES = 4
LAYOUTS = {
    "fractions": candidate_layout(NUM, DEN, INDICES),
    "numbers": candidate_layout(NUM, NO_DEN, INDICES),
}


TREE = Claim(
    "the argmin tree gives the smallest fraction, of equal ones the smallest index, and an excluded one"
    " only where all"
    " are; 1 / 0 loses against any other",
    sizes="3 and 4 fractions of 3 and 2 bits, 5 numbers of 3 bits",
    depth="every run",
)
SEQUENCE = Claim(
    "the argmin sequence does the same, with pauses between candidates and indices in any order",
    sizes="2 fractions, 4 numbers, in any number of sequences",
    depth="every run",
)


def _ranks() -> dict[tuple[int, ...], int]:
    """Of each fraction, by its terms as bits: how many smaller ones there are; 1 / 0 is the largest."""
    size = len(NUM)
    costs = {(n % size, d): Fraction(n, d) for n in NUM for d in DEN if d}
    order = sorted(set(costs.values()))
    return {**{terms: order.index(cost) for terms, cost in costs.items()}, (1, 0): len(order)}


RANKS = _ranks()
RANK = Shape.cast(range(max(RANKS.values()) + 1))


def key(m: Module, c: data.View, name: str, index: Value) -> Signal:
    """A number that is smaller for the better of two candidates."""
    rank = Signal(RANK, name=f"rank_{name}")
    m.d.comb += rank.eq(looked_up(RANKS, c.num.as_unsigned(), c.den) if len(c.den) else c.num - NUM[0])
    found = Signal(len(index) + RANK.width + 1, name=f"key_{name}")
    m.d.comb += found.eq(Cat(index, rank, c.excluded))
    return found


def drive(m: Module, c: data.View, num: Value, den: Value) -> None:
    """Any cost but those that none is: only 1 / 0 has no denominator."""
    m.d.comb += c.num.eq(num)
    if len(c.den):
        m.d.comb += [c.den.eq(den), c.num.eq(Mux(den == 0, 1, num))]


class Tree(Component):
    """`ArgminTree` beside its statement: all candidates at once, the excluded ones last."""

    def __init__(self, block: Any, plain: bool, count: int) -> None:
        self._tree = block(NUM, NO_DEN if plain else DEN, count)
        self._count = count
        self.latency = self._tree.latency
        ports = {
            f"{term}_{k}": In(shape) for k in range(count) for term, shape in (("num", NUM), ("den", DEN))
        }
        super().__init__({"running": In(range(count + 1)), **ports})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.tree = tree = self._tree
        best = None
        bits = len(tree.o.index)
        for k in range(self._count):
            drive(m, tree.i[k], getattr(self, f"num_{k}"), getattr(self, f"den_{k}"))
            m.d.comb += tree.i[k].excluded.eq(self.running <= k)
            mine = key(m, tree.i[k], str(k), Const(k, bits))
            best = mine if best is None else Mux(mine < best, mine, best)
        expected = late(m, Value.cast(best), tree.latency, "expected")
        got = key(m, tree.o, "got", tree.o.index)
        none = expected[-1] & tree.o.excluded  # then nothing else counts
        m.d.comb += Assert((got == expected) | none)
        return m


class Sequence(Component):
    """`ArgminSequence` beside its statement: `count` candidates a time, with pauses, in any order."""

    num: In(NUM)
    den: In(DEN)
    index: In(range(INDICES))
    excluded: In(1)
    valid: In(1)

    def __init__(self, block: Any, layout: str, count: int) -> None:
        self._dut = block(LAYOUTS[layout], count)
        self._count = count
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.dut = dut = self._dut
        drive(m, dut.i, self.num, self.den)
        ends = Signal()
        before = Signal(range(self._count))
        m.d.comb += [
            dut.i.index.eq(self.index),
            dut.i.excluded.eq(self.excluded),
            dut.valid.eq(self.valid),
            ends.eq(before == self._count - 1),
            dut.last.eq(ends),
        ]
        mine = key(m, dut.i, "mine", dut.i.index)
        kept, best = Signal.like(mine, name="kept"), Signal.like(mine, name="best")
        m.d.comb += best.eq(Mux((before == 0) | (mine < kept), mine, kept))
        with m.If(self.valid):
            m.d.sync += [kept.eq(best), before.eq(Mux(ends, 0, before + 1))]
        due = late(m, self.valid & ends, dut.latency, "due")
        expected = late(m, best, dut.latency, "expected")
        got = key(m, dut.o, "got", dut.o.index)
        none = expected[-1] & dut.o.excluded
        m.d.comb += Assert(~due | (got == expected) | none)
        return m


@TREE.proven
@pytest.mark.parametrize(("plain", "count"), [(True, 5), (False, 3), (False, 4)])
def test_the_tree_finds_the_best_in_every_run(plain: bool, count: int, tmp_path: Path) -> None:
    dut = Tree(ArgminTree, plain, count)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "every run"


@SEQUENCE.proven
@pytest.mark.parametrize(("layout", "count"), [("numbers", 4), ("fractions", 2)])
def test_the_sequence_finds_the_best(layout: str, count: int, tmp_path: Path) -> None:
    assert every_run(Sequence(ArgminSequence, layout, count), tmp_path) == "every run"


FAULTS = {
    "ties go to the larger": (
        "compared[1].index < compared[0].index",
        "compared[1].index > compared[0].index",
    ),
    "excluded ones win": (
        "wins = ~compared[1].excluded & (compared[0].excluded | b_better)",
        "wins = b_better",
    ),
    "products of a candidate's own": (
        "operand_a.num * operand_b.den, operand_b.num * operand_a.den",
        "operand_a.num * operand_a.den, operand_b.num * operand_b.den",
    ),
}
TREE_FAULTS = {
    "halves exclude nothing": ("wins = right_smaller & ~compared[1].excluded", "wins = right_smaller"),
    "ties go to the upper half": ("wins = right_smaller &", "wins = (right_smaller | (right == left)) &"),
    "products of a candidate's own": FAULTS["products of a candidate's own"],
}


@SEQUENCE.refuted
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_the_sequence_is_refuted(fault: str, tmp_path: Path) -> None:
    dut = Sequence(mutated(ArgminSequence, *FAULTS[fault]), "fractions", 2)
    assert some_clocks(dut, tmp_path, 12) == "refuted"


@TREE.refuted
@pytest.mark.parametrize("fault", TREE_FAULTS)
def test_a_fault_in_the_tree_is_refuted(fault: str, tmp_path: Path) -> None:
    dut = Tree(mutated(ArgminTree, *TREE_FAULTS[fault]), False, 3)
    assert pipeline_proof(dut, tmp_path, dut.latency) == "refuted"
