"""Fig. 4: the cost curve of one pixel, before and after the compensating rule."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from softdepth.paper import variants
from softdepth.paper.readings import Reading
from softdepth.paper.scenes import Scene

BEFORE, AFTER = 62, 16
"""What the paper has at its pixel."""

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
    s = sums(scene, reading, x, y)
    before = [s[window] for window in reading.windows]
    after = variants.compensated(before, s[judged_by], np.arange(reading.candidates), reading.label)
    without, with_rule = (variants.cost(each, "soft_min_1", reading) for each in (before, after))
    return Point(
        x=x,
        y=y,
        judged_by=judged_by,
        before=int(without.argmin()) + 1,
        after=int(with_rule.argmin()) + 1,
        costs_before=without.tolist(),
        costs_after=with_rule.tolist(),
    )


def sums(scene: Scene, reading: Reading, x: int, y: int) -> Mapping[int, NDArray[np.int32]]:
    """The RGB SAD of every candidate, by window, around a pixel whose windows stay inside both images."""
    radius = max(reading.windows) // 2
    rows = slice(y - radius, y + radius + 1)
    left_is_reference = reading.view == "left"
    here, there = (scene.left, scene.right) if left_is_reference else (scene.right, scene.left)
    found: dict[int, list[int]] = {window: [] for window in reading.windows}
    for d in range(reading.candidates):
        partner = x - d if left_is_reference else x + d
        a, b = (
            image[rows, c - radius : c + radius + 1].astype(np.int32)
            for image, c in ((here, x), (there, partner))
        )
        for window, value in variants.sums(np.abs(a - b).sum(2, dtype=np.int32), reading.windows).items():
            found[window].append(int(value[0, 0]))
    return {window: np.array(values, np.int32) for window, values in found.items()}
