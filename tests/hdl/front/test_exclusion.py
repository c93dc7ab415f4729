"""Exclusion: which candidates' windows leave the other image, for every lane and step of every pixel."""

from itertools import product
from random import Random

import pytest

from softdepth.hdl.front.exclusion import Exclusion
from softdepth.hdl.front.right_columns import candidate
from tests.support.simulation import Ports, config, observe, sad


@pytest.mark.parametrize("gaps", [0, 0.4])
@pytest.mark.parametrize(
    ("steps", "lanes"), [k for k in product((1, 2, 3, 4, 8), (1, 2, 3, 4, 7, 16)) if k != (1, 1)]
)
def test_candidates_beyond_the_room(steps: int, lanes: int, gaps: float) -> None:
    """Lines of one inner pixel, shorter and longer than the candidates need, one after the other.

    Before a line's first inner pixel the outputs say nothing. In clocks without a step the other
    inputs are anything.
    """
    c = config(disparities=steps * lanes, lanes=lanes, cost="sum", criteria=[sad(3)])
    random = Random(steps * lanes)
    widths = [1, 2, c.disparities - 1, c.disparities, c.disparities + 6, 1, c.disparities // 2 + 1, 3]
    drive: list[Ports] = []
    entered: list[tuple[int, int, int]] = []  # clock, inner pixel of its line, step
    for width in widths:
        for inner in range(-2, width):
            for step in range(steps):
                while random.random() < gaps:
                    drive.append({"valid": 0, "first": 0, "starts": random.getrandbits(1)})
                if inner >= 0:
                    entered.append((len(drive), inner, step))
                drive.append({"valid": 1, "first": step == 0, "starts": inner == 0})
    dut = Exclusion(c)
    idle: list[Ports] = [{"valid": 0}] * dut.latency
    seen = observe(dut, [*drive, *idle], "lanes")
    excluded = 0
    for clock, inner, step in entered:
        # The reference pixel is `reach_left + inner`, and candidate d takes d columns more to its left.
        expected = [inner - candidate(c, lane, step) < 0 for lane in range(lanes)]
        assert [bool(seen[clock + dut.latency] >> lane & 1) for lane in range(lanes)] == expected
        assert expected == sorted(expected), "excluded candidates are the last ones"
        excluded += sum(expected)
    assert excluded > 2 * c.disparities


def test_a_wide_line_stays_without_exclusions() -> None:
    """What counts does not wrap once all candidates have room."""
    c = config(disparities=6, lanes=3, cost="sum", criteria=[sad(3)])
    pixels = 200
    drive: list[Ports] = [
        {"valid": 1, "first": step == 0, "starts": inner == 0}
        for inner in range(pixels)
        for step in range(c.steps)
    ]
    seen = observe(Exclusion(c), drive, "lanes")
    assert set(seen[Exclusion.latency + c.steps * (c.disparities - 1) :]) == {0}
