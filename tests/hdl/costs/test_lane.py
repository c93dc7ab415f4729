"""Lane: from columns to a candidate's cost."""

from random import Random
from typing import Any

import pytest

from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.costs.lane import Lane
from tests.support.expected import fraction, window_sums
from tests.support.simulation import config, looked_up, observe, sad

TOP = {"reading": "top", "threshold": 1500}


@pytest.mark.parametrize(
    "keys",
    [
        {"cost": "sum", "criteria": [sad(5, 1)]},
        {"operator": "mean", "criteria": [sad(3, -1, 10), sad(3, 0, 10), sad(1, 2, 9)], "compensation": TOP},
        {"operator": "mean", "criteria": [sad(3), sad(5), sad(7)], "stored_rows": 4},
        {"operator": "min", "criteria": [sad(1, 0, 8), sad(3, 0, 11), sad(5, 0, 12)], "compensation": TOP},
    ],
)
def test_cost_of_every_candidate(keys: dict[str, Any]) -> None:
    c = config(disparities=4, lanes=2, **keys)
    random = Random(6)
    pixels = c.min_width + 10
    lines = c.stored_rows + 1
    rows = range(lines + c.min_height - 1)

    def picture(scale: int) -> list[list[list[int]]]:
        return [[[random.randrange(scale) for _ in range(3)] for _ in range(pixels)] for _ in rows]

    left = picture(256)
    right = [picture(scale) for scale in (256, 128)]  # one a step
    near = [[random.getrandbits(1) for _ in range(c.steps)] for _ in range(pixels)]
    dut = Lane(c)
    clocks: list[dict[str, Any]] = [{"valid": 0} for _ in range(4 * pixels * lines + dut.latency)]
    entered: list[tuple[int, int, int]] = []
    clock = 0
    for y in range(lines):
        new = range(y + c.stored_rows, y + c.min_height)
        for p in range(pixels):
            clock += random.choice((0, 0, 1, 2))
            for k in range(c.steps):
                clocks[clock] |= {
                    "valid": 1,
                    "place": p * c.steps + k,
                    "left": [left[row][p] for row in new],
                    "right": [right[k][row][p] for row in new],
                }
                clocks[clock + dut.criteria_latency]["near"] = near[p][k]
                if y == lines - 1:
                    entered.append((clock, p, k))
                clock += 1
    drive = looked_up(list(clocks))
    got = [dut.o.shape().from_bits(bits) for bits in observe(dut, drive, "o")]

    def columns(image: list[list[list[int]]]) -> list[list[list[int]]]:
        """Those of the last line, whose stored rows are known."""
        return [[image[row][p] for row in rows[-c.min_height :]] for p in range(pixels)]

    sums = [window_sums(columns(left), columns(right[k]), c) for k in range(c.steps)]
    for clock, p, k in entered:
        if p >= c.reach_left + c.reach_right:
            at = LOOKUP_AHEAD + clock + dut.latency
            den = got[at].den if c.cost == "fuzzy" else 1
            assert (got[at].num, den) == fraction(sums[k][p], bool(near[p][k]), c), (p, k)
