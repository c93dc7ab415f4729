"""The plan of functional coverage can be reached, and the suite reaches most of it."""

import pytest

from tests.cover.functional import plan, reached

LONGER = 40


@pytest.mark.slow
def test_the_suite_reaches_most_of_the_plan_and_more_runs_all_of_it() -> None:
    bins = plan()
    assert not bins - reached(LONGER).keys(), "no configuration is ever drawn there"
    assert len(bins - reached().keys()) <= len(bins) / 2
    assert not reached(LONGER).keys() - bins, "the plan lacks what is drawn"


def test_faults_and_ends_are_reached_by_the_suite_itself() -> None:
    found = reached()
    assert all(found[each] for each in plan() if each[0] in ("fault", "ends"))
