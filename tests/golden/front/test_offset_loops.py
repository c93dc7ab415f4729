"""Candidates that do not begin at 0, against plain loops over every pixel and candidate."""

import numpy as np
import pytest

from softdepth.golden.fixed_model import disparity
from softdepth.spec.validity import Validity
from tests.support.simulation import config, sad

HEIGHT, WIDTH, CANDIDATES = 6, 17, 5


@pytest.mark.parametrize("dx", [0, 1])
@pytest.mark.parametrize("first", [-4, -1, 0, 2])
def test_every_pixel(first: int, dx: int) -> None:
    c = config(
        cost="sum", criteria=[sad(3, dx)], disparities=CANDIDATES, lanes=1, min_disparity=first, max_width=32
    )
    left, right = np.random.default_rng(first + 9).integers(0, 256, (2, HEIGHT, WIDTH, 3), dtype=np.uint8)
    found = disparity(left, right, c)

    def sum_at(y: int, x: int, d: int) -> int:
        """What the window of (x, y) and that of its partner d columns to the left differ by."""
        rows, columns = range(y - 1, y + 2), range(x + dx - 1, x + dx + 2)
        return sum(int(abs(left[v, u].astype(int) - right[v, u - d]).sum()) for v in rows for u in columns)

    # Of views moved so that candidates begin at 0, what overlaps counts: in the right view from here on.
    begins = max(-first, 0)
    for y in range(HEIGHT):
        for x in range(WIDTH):
            low, high = x + dx - 1, x + dx + 1
            fits = [
                d
                for d in range(first, first + CANDIDATES)
                if 1 <= y < HEIGHT - 1 and low - d >= begins and low >= 0 and high < WIDTH
            ]
            beyond = high - first >= WIDTH  # of the first candidate, whose partner lies furthest right
            wanted, code = 0, Validity.BORDER
            if first in fits and not beyond:
                wanted = min(fits, key=lambda d: (sum_at(y, x, d), d))
                code = Validity.FULL if len(fits) == CANDIDATES else Validity.PARTIAL
            assert (found.disparity[y, x], found.code[y, x]) == (wanted, code), f"y={y} x={x}"
    assert len(np.unique(found.disparity[found.code != Validity.BORDER])) > 2
