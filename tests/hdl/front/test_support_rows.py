"""SupportRows: which of a frame's rows complete a support."""

import pytest

from softdepth.hdl.front.support_rows import SupportRows
from tests.support.simulation import Ports, observe


@pytest.mark.parametrize("output", ["rows", "first", "inner"])
@pytest.mark.parametrize("reach", [1, 2, 4])
def test_rows_of_frames_of_any_height(reach: int, output: str) -> None:
    clocks: list[Ports] = []
    expected: list[int] = []
    for height in (1, 3 * reach, reach + 1, 2 * reach + 1, 1, reach):
        for row in range(height):
            said = {"rows": min(row, 2 * reach), "first": row == reach, "inner": row >= 2 * reach}
            clocks += [{"line_ends": 0, "frame_ends": 0}, {"line_ends": 1, "frame_ends": row == height - 1}]
            expected += [said[output]] * 2
    assert observe(SupportRows(reach), clocks, output) == expected
