"""Fig. 4: the cost curve of one pixel, before and after the compensating rule."""

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from softdepth.config import Compensation
from softdepth.golden.sad import box_sum
from softdepth.paper import fuzzy
from softdepth.paper.readings import Reading
from softdepth.paper.scenes import Scene

PUBLISHED_BEFORE, PUBLISHED_AFTER = 62, 16
COLUMN, ROW = 254, 68
"""The pixel that the paper names (x = 254, y = -68), columns and rows counted from zero."""

PIXELS = ((COLUMN, ROW), (COLUMN, ROW - 1))
"""That pixel, and the one above it: row 68 when rows are counted from one."""


class Point(BaseModel):
    """A pixel's curves. Indices count the candidates from one, as the paper's figure does.

    Members
    -------
    x, y : the pixel, counted from zero.
    judged_by : the window whose sum the rule compares with its threshold.
    before, after : index of the least cost without the rule, and with it.
    costs_before, costs_after : the curves, candidate d = 0 first.
    """

    x: int
    y: int
    judged_by: int
    before: int
    after: int
    costs_before: list[float]
    costs_after: list[float]


def points(scene: Scene, reading: Reading) -> list[Point]:
    """The curves of `PIXELS` with soft-min I, for the rule judged by each of the reading's windows."""
    return [point(scene, reading, x, y, window) for x, y in PIXELS for window in reading.windows]


def point(scene: Scene, reading: Reading, x: int, y: int, judged_by: int) -> Point:
    """The curve of one pixel; the rule fires where the `judged_by` x `judged_by` SAD is above 1200."""
    rule = Compensation()
    s = sums(scene, reading, x, y)
    fires = (np.arange(reading.candidates) >= rule.min_disparity) & (s[judged_by] > rule.threshold)
    before = [s[window] for window in reading.windows]
    after = [np.where(fires, 2 * reading.label, values) for values in before]
    costs = [fuzzy.cost(each, "soft_min_1", reading.label) for each in (before, after)]
    return Point(
        x=x,
        y=y,
        judged_by=judged_by,
        before=int(costs[0].argmin()) + 1,
        after=int(costs[1].argmin()) + 1,
        costs_before=costs[0].tolist(),
        costs_after=costs[1].tolist(),
    )


def sums(scene: Scene, reading: Reading, x: int, y: int) -> dict[int, NDArray[np.int32]]:
    """The RGB SAD of every candidate, by window, around a pixel far enough from the edges."""
    radius = max(reading.windows) // 2
    rows = slice(y - radius, y + radius + 1)
    sign = 1 if reading.view == "right" else -1
    here, there = (scene.right, scene.left) if reading.view == "right" else (scene.left, scene.right)
    found: dict[int, list[int]] = {window: [] for window in reading.windows}
    for d in range(reading.candidates):
        a, b = (
            image[rows, c - radius : c + radius + 1].astype(np.int32)
            for image, c in ((here, x), (there, x + sign * d))
        )
        difference = np.abs(a - b).sum(2, dtype=np.int32)
        for window in reading.windows:
            inner = slice(radius - window // 2, radius + window // 2 + 1)
            found[window].append(int(box_sum(difference[inner, inner], window)[0, 0]))
    return {window: np.array(values, np.int32) for window, values in found.items()}
