"""RowMemory: what the lines before cost at each place, whatever comes between."""

from random import Random

import pytest

from softdepth.hdl.costs.criteria.row_memory import RowMemory
from tests.support.simulation import Ports, observe

MAXIMUM = 765


@pytest.mark.parametrize("gaps", [0, 0.5])
@pytest.mark.parametrize(
    ("rows", "places", "widths"),
    [
        (1, 8, [4, 4, 8, 8]),
        (2, 4, [4] * 6),
        (4, 20, [20, 20, 17, 5, 5, 20, 20, 20, 20, 20]),
        (6, 9, [9] * 15),
    ],
)
def test_costs_of_the_lines_before(rows: int, places: int, widths: list[int], gaps: float) -> None:
    """Lines of several widths; lookups follow one another, or with idle clocks in which all may change."""
    random = Random(rows * places)
    latency = RowMemory.latency
    drive: list[dict[str, int]] = []
    history: dict[int, list[int]] = {place: [] for place in range(places)}
    lookups: list[tuple[int, list[int]]] = []
    newest: dict[int, int] = {}  # by clock
    for width in widths:
        for place in range(width):
            while random.random() < gaps:
                drive.append({"valid": 0, "place": random.randrange(places)})
            cost = random.choice((0, MAXIMUM, random.randint(0, MAXIMUM)))
            newest[len(drive) + latency] = cost
            if len(history[place]) >= rows:
                lookups.append((len(drive), history[place][-rows:]))
            history[place].append(cost)
            drive.append({"valid": 1, "place": place})
    clocks: list[Ports] = [
        (drive[clock] if clock < len(drive) else {"valid": 0})
        | {"newest": newest.get(clock, random.randint(0, MAXIMUM))}
        for clock in range(len(drive) + latency + 1)
    ]
    dut = RowMemory(range(MAXIMUM + 1), rows, places)
    layout = dut.rows.shape()
    seen = observe(dut, clocks, "rows")
    for clock, expected in lookups:
        assert list(layout.from_bits(seen[clock + latency])) == expected
    assert len(lookups) >= 2 * min(widths)


def test_bits() -> None:
    dut = RowMemory(range(MAXIMUM + 1), 6, 500)
    assert dut.bits == 6 * 10 * 500
    observe(dut, [{}], "rows")
