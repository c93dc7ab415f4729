"""RightColumns: every lane and step sees the column of its candidate."""

from itertools import chain
from random import Random

import pytest

from softdepth.hdl.front.right_columns import RightColumns, candidate
from tests.support.simulation import Ports, config, observe, sad

BITS = 12


@pytest.mark.parametrize(("disparities", "lanes"), [(6, 2), (16, 1), (16, 4), (16, 16), (5, 5), (3, 1)])
def test_lanes_and_steps_share_the_candidates_in_segments(disparities: int, lanes: int) -> None:
    c = config(disparities=disparities, lanes=lanes)
    by_lane = [[candidate(c, lane, step) for step in range(c.steps)] for lane in range(lanes)]
    assert sorted(chain.from_iterable(by_lane)) == list(range(disparities))
    for lane, segment in enumerate(by_lane):  # the far end first
        assert segment == sorted(range(lane * c.steps, (lane + 1) * c.steps), reverse=True)


@pytest.mark.parametrize("gaps", [0, 0.4])
@pytest.mark.parametrize("lanes", [2, 3])
@pytest.mark.parametrize("steps", [1, 2, 3, 4, 10, 16])
def test_column_of_each_candidate(steps: int, lanes: int, gaps: float) -> None:
    c = config(disparities=steps * lanes, lanes=lanes, cost="sum", criteria=[sad(3)])
    random = Random(steps * lanes)
    pixels = c.disparities + 12
    row = [random.getrandbits(BITS) for _ in range(pixels)]
    clocks: list[Ports] = []
    expected: list[tuple[int, int, int]] = []  # clock, x, step
    for x in range(pixels):
        for step in range(steps):
            while random.random() < gaps:
                clocks.append({"valid": 0, "first": 0, "column": random.getrandbits(BITS)})
            expected.append((len(clocks), x, step))
            clocks.append({"valid": 1, "first": step == 0, "column": row[x]})
    seen = observe(RightColumns(c, BITS), clocks, "columns")
    compared = 0
    for clock, x, step in expected:
        for lane in range(lanes):
            d = candidate(c, lane, step)
            if d <= x:
                assert seen[clock] >> BITS * lane & 2**BITS - 1 == row[x - d], (x, lane, step)
                compared += 1
    assert compared > 6 * c.disparities
