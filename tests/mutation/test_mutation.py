"""A sample of `make mutation`: faults in a small core are found by the quick regression."""

import tomllib
from itertools import permutations, product

import pytest

from tests.mutation.netlist import Mutant, changes
from tests.mutation.page import KINDS, page
from tests.mutation.study import EXPLAINED, Outcome, study

SAMPLE, FOUND = 30, 27


@pytest.mark.slow
def test_a_sample_of_faults_is_found() -> None:
    outcomes = study("lite", SAMPLE, seed=2, thorough=False)
    assert len({outcome.mutant.what for outcome in outcomes}) > SAMPLE // 2
    # So few need not lie in each room, but they are spread.
    assert len({outcome.mutant.room for outcome in outcomes}) > 1
    assert len({outcome.mutant.block for outcome in outcomes}) > SAMPLE // 4
    missed = [str(outcome.mutant) for outcome in outcomes if not outcome.killed]
    assert SAMPLE - len(missed) >= FOUND, missed


CELLS = {
    "$eq": lambda a, b: a == b,
    "$ne": lambda a, b: a != b,
    "$reduce_or": lambda a, b: any(a),
    "$reduce_and": lambda a, b: all(a),
    "$logic_not": lambda a, b: not any(a),
}


@pytest.mark.parametrize("kind", CELLS)
def test_only_faults_that_change_nothing_are_left_out(kind: str) -> None:
    read = {1, 2, 3}
    for other in product((0, 1), repeat=3):
        cell = {"type": kind, "connections": {"A": [1, 2, 3], "B": [str(bit) for bit in other]}}
        for (bit, control), value in product(permutations(range(3), 2), (0, 1)):
            options = {"-port": "A", "-portbit": bit, "-mode": f"cnot{value}", "-ctrlbit": control}
            shows = False
            for bits in product((0, 1), repeat=3):
                turned = tuple(b ^ (k == bit and bits[control] == value) for k, b in enumerate(bits))
                shows |= CELLS[kind](turned, other) != CELLS[kind](bits, other)
            assert changes(cell, options, read) == shows


def test_what_is_not_found_is_listed_with_its_reason() -> None:
    mutant = Mutant(1, "front.guard", "hdl/front/frame_guard.py", "a.eq(b | c)", "or Y[0] stuck at 1")
    outcomes = [
        Outcome(mutant, 3, "result 17 is wrong"),
        Outcome(mutant, None, "", "equivalent", "b is never 0"),
        Outcome(mutant, None, ""),
    ]
    text = page({"sad": outcomes}, "today")
    assert "3 faults, of which 1 are found (33.3%)" in text
    assert "| sad | 1 of 3 | - | - | - | - | 33.3% |" in text
    assert "result is wrong (1)" in text
    assert "no input can tell it from the sound core: b is never 0 |" in text
    assert "| not explained |" in text


def test_explanations_are_of_a_known_kind() -> None:
    for each in tomllib.loads(EXPLAINED.read_text())["explained"]:
        assert each["kind"] in KINDS.keys() - {""}
        assert each["reason"]
        assert each.keys() & {"block", "code", "what"}
