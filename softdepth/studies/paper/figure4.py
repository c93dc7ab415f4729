"""Fig. 4: the cost curve of one pixel, before and after the compensating rule."""

from pydantic import BaseModel

from softdepth.golden import float_model
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.scenes import Scene

BEFORE, AFTER = 62, 16
"""What the paper has at its pixel."""

COLUMN, ROW = 254, 68
"""The pixel that the paper names (x = 254, y = -68). Like its disparities, it is met counting from one."""


class Point(BaseModel):
    """A pixel's curves. Everything is counted from one: the pixel, and the candidates.

    Members
    -------
    x, y : the pixel.
    windows : the criteria.
    judged_by : the window whose sum the rule compares with its threshold.
    before, after : index of the least cost without the rule, and with it.
    costs_before, costs_after : the curves, candidate d = 0 first.
    """

    x: int
    y: int
    windows: tuple[int, ...]
    judged_by: int
    before: int
    after: int
    costs_before: list[float]
    costs_after: list[float]


def points(scene: Scene, readings: tuple[Reading, ...]) -> list[Point]:
    """The pixel's curves in each reading, for the rule judged by each of its windows."""
    return [
        point(scene, reading, COLUMN, ROW, judge)
        for reading in readings
        for judge in range(1, len(reading.windows) + 1)
    ]


def point(scene: Scene, reading: Reading, x: int, y: int, judge: int) -> Point:
    """The curves of one pixel, counted from one, with soft-min I; the rule looks at criterion `judge`.

    The pixel's windows must stay inside both images: nothing is replicated here.
    """
    off, on = (reading.config("soft_min_1", rule, judge) for rule in ("off", "top"))
    before, after = (
        float_model.costs(scene.left, scene.right, config, x - 1, y - 1, label=reading.label)
        for config in (off, on)
    )
    return Point(
        x=x,
        y=y,
        windows=reading.windows,
        judged_by=reading.windows[judge - 1],
        before=int(before.argmin()) + 1,
        after=int(after.argmin()) + 1,
        costs_before=before.tolist(),
        costs_after=after.tolist(),
    )
