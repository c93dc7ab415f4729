"""SadCriteria: mixed windows and shifts, with and without stored rows, against plain loops."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.costs.criteria.sad import SadCriteria
from tests.support.expected import window_sums
from tests.support.simulation import Ports, config, looked_up, observe, sad

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
@pytest.mark.parametrize("share", [0, 0.5, 1])
@pytest.mark.parametrize("name", CASES)
def test_sums_of_every_candidate(name: str, share: float, steps: int) -> None:
    """Lines follow one another until all stored rows are known; `share` of the rows above are stored."""
    criteria = CASES[name]
    keys = {"cost": "fuzzy" if len(criteria) == 3 else "sum", "criteria": criteria}
    c = config(**keys, disparities=2 * steps, lanes=2)
    c = config(**keys, disparities=2 * steps, lanes=2, stored_rows=int(share * 2 * c.reach_rows))
    random = Random(len(name))
    pixels = c.min_width + 5
    lines = c.stored_rows + 2

    def pixel(extreme: int | None = None) -> list[int]:
        return [random.getrandbits(8) if extreme is None else extreme for _ in range(3)]

    # The last half is black against white: every sum reaches its maximum in the end, if it is wide enough.
    half = pixels // 2
    rows = range(lines + c.min_height - 1)
    left = [[pixel(0 if p >= half else None) for p in range(pixels)] for _ in rows]
    right = [[[pixel(255 if p >= half else None) for p in range(pixels)] for _ in rows] for _ in range(steps)]

    clocks: list[Ports] = []
    entered: list[tuple[int, int, int, int]] = []
    for y in range(lines):
        new = range(y + c.stored_rows, y + c.min_height)
        for p in range(pixels):
            for k in range(steps):
                while random.random() < 0.3:
                    junk: Any = [[pixel() for _ in new] for _ in range(2)]
                    clocks.append(
                        {"valid": 0, "left": junk[0], "right": junk[1], "place": random.randrange(c.places)}
                    )
                entered.append((len(clocks), y, p, k))
                clocks.append(
                    {
                        "valid": 1,
                        "place": p * steps + k,
                        "left": [left[row][p] for row in new],
                        "right": [right[k][row][p] for row in new],
                    }
                )
    dut = SadCriteria(c, c.criteria)
    idle: list[Ports] = [{"valid": 0}] * dut.latency
    layout: Any = dut.o.shape()
    seen = observe(dut, looked_up([*clocks, *idle]), "o")

    def columns(image: list[list[list[int]]], y: int) -> list[list[list[int]]]:
        return [[image[row][p] for row in range(y, y + c.min_height)] for p in range(pixels)]

    expected = {
        (y, k): window_sums(columns(left, y), columns(right[k], y), c)
        for y in range(c.stored_rows, lines)
        for k in range(steps)
    }
    support = c.reach_left + c.reach_right
    compared = 0
    for clock, y, p, k in entered:
        if p < support or y < c.stored_rows:
            continue
        sums = layout.from_bits(seen[LOOKUP_AHEAD + clock + dut.latency])
        assert [sums[f"s{i}"] for i in range(len(criteria))] == expected[y, k][p], (y, p, k)
        compared += 1
    assert compared >= 12 * steps
