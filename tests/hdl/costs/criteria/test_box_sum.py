"""BoxSum: every odd window, with candidates that take turns."""

from random import Random

import pytest

from softdepth.hdl.costs.criteria.box_sum import BoxSum
from tests.support.simulation import Ports, observe

MAXIMUM = 765


@pytest.mark.parametrize("steps", [1, 2, 5])
@pytest.mark.parametrize("window", range(1, 16, 2))
def test_sums_the_last_pixels_of_the_same_candidate(window: int, steps: int) -> None:
    random = Random(window * steps)
    pixels = window + 25
    cost = [
        [MAXIMUM if p in range(2, window + 4) else random.randint(0, MAXIMUM) for _ in range(steps)]
        for p in range(pixels)
    ]
    clocks: list[Ports] = []
    entered: list[tuple[int, int, int]] = []  # clock, pixel, candidate
    for p in range(pixels):
        for k in range(steps):
            while random.random() < (0.4 if p > pixels // 2 else 0):
                clocks.append({"valid": 0, "i": random.randint(0, MAXIMUM)})
            entered.append((len(clocks), p, k))
            clocks.append({"valid": 1, "i": cost[p][k]})
    dut = BoxSum(MAXIMUM, window, steps)
    idle: list[Ports] = [{"valid": 0}] * dut.latency
    seen = observe(dut, [*clocks, *idle], "o")
    sums = {
        (p, k): sum(cost[q][k] for q in range(p - window + 1, p + 1))
        for _, p, k in entered
        if p >= window - 1
    }
    got = {(p, k): seen[clock + dut.latency] for clock, p, k in entered if p >= window - 1}
    assert got == sums
    assert dut.maximum == max(sums.values()) == MAXIMUM * window
