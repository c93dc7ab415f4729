"""A sample of `make mutation`: faults in a small core are found by the quick regression."""

import tomllib

import pytest

from tests.mutation.netlist import Mutant
from tests.mutation.page import KINDS, page
from tests.mutation.study import EXPLAINED, Outcome, study

SAMPLE, FOUND = 30, 0.9


@pytest.mark.slow
def test_a_sample_of_faults_is_found() -> None:
    outcomes = study("lite", SAMPLE, seed=2, thorough=False)
    assert len({outcome.mutant.what for outcome in outcomes}) > SAMPLE // 2
    assert {"front", "costs", "winners"} <= {outcome.mutant.room for outcome in outcomes}
    missed = [str(outcome.mutant) for outcome in outcomes if not outcome.killed]
    assert len(missed) <= (1 - FOUND) * SAMPLE, missed


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
