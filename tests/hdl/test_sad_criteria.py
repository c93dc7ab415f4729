"""SadCriteria: mixed windows and shifts, against plain loops over the pixels."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.criteria.sad import SadCriteria

from .expected import window_sums
from .support import Ports, config, observe, sad

CASES: dict[str, list[dict[str, int]]] = {
    "paper": [sad(3), sad(5), sad(7)],
    "lite": [sad(3, -2), sad(3, 0), sad(3, 2)],
    "single pixels": [sad(1, -2), sad(3), sad(1)],
    "plain 3x3": [sad(3)],
    "far right": [sad(3, 6)],
    "far left": [sad(3, -6)],
    "windows far apart": [sad(9), sad(3), sad(3)],
    "wide and narrow": [sad(1, 3), sad(11), sad(5, -4)],
    "same window, all left": [sad(5, -3), sad(5, -4), sad(3, -1)],
    "nothing at the centre": [sad(3, 5), sad(1, 4), sad(7, 9)],
}


@pytest.mark.parametrize("steps", [1, 3])
@pytest.mark.parametrize("name", CASES)
def test_sums_of_every_candidate(name: str, steps: int) -> None:
    criteria = CASES[name]
    c = config(
        cost="fuzzy" if len(criteria) == 3 else "sad", criteria=criteria, disparities=2 * steps, lanes=2
    )
    random = Random(len(name))
    pixels = c.min_width + 5

    def column(extreme: int | None = None) -> list[list[int]]:
        return [
            [random.getrandbits(8) if extreme is None else extreme for _ in range(3)]
            for _ in range(c.min_height)
        ]

    # The last half is black against white: every sum reaches its maximum in the end, if it is wide enough.
    left = [column(0 if p >= pixels // 2 else None) for p in range(pixels)]
    right = [[column(255 if p >= pixels // 2 else None) for _ in range(steps)] for p in range(pixels)]
    clocks: list[Ports] = []
    entered: list[tuple[int, int, int]] = []
    for p in range(pixels):
        for k in range(steps):
            while random.random() < 0.3:
                clocks.append({"valid": 0, "left": column(), "right": column()})
            entered.append((len(clocks), p, k))
            clocks.append({"valid": 1, "left": left[p], "right": right[p][k]})
    dut = SadCriteria(c, c.criteria)
    idle: list[Ports] = [{"valid": 0}] * dut.latency
    layout: Any = dut.o.shape()
    seen = observe(dut, [*clocks, *idle], "o")

    expected = [window_sums(left, [row[k] for row in right], c) for k in range(steps)]
    support = c.reach_left + c.reach_right
    compared = 0
    for clock, p, k in entered:
        if p < support:
            continue
        sums = layout.from_bits(seen[clock + dut.latency])
        assert [sums[f"s{i}"] for i in range(len(criteria))] == expected[k][p], (p, k)
        compared += 1
    assert compared >= 6 * steps
