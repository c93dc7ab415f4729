"""One map of the evaluation: what names it, and how it is computed."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from softdepth.golden import fixed_model, float_model
from softdepth.golden.maps import DisparityMap
from softdepth.golden.score.metrics import Metrics, evaluate, paper_rmse
from softdepth.spec.compensation import Reading as Rule
from softdepth.spec.config import Config, Operator
from softdepth.studies.paper import matchers, prototype
from softdepth.studies.paper.margins import Margins
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.scenes import Scene

Engine = Literal["float", "fixed", "rtl"]
Advance = Callable[[int], None]


@dataclass(frozen=True)
class Cell:
    """A scene under a reading, with an operator (None: the method has none) and an engine.

    The compensating rule `rule` looks at criterion number `judge`, from one.
    """

    scene: str
    reading: Reading
    operator: Operator | None
    engine: Engine
    rule: Rule = "off"
    judge: int = 1

    @property
    def config(self) -> Config:
        """The core that computes it."""
        return self.reading.config(self.operator or "mean", self.rule, self.judge)


@dataclass(frozen=True, eq=False)
class Found:
    """A map: H x W disparities in pixels, where there is a result, and the seconds that it took."""

    disparity: np.ndarray
    valid: np.ndarray
    seconds: float


def compute(cell: Cell, scene: Scene, advance: Advance | None = None) -> Found:
    """The map of `cell`. `advance` hears of a simulation's progress, in pixels of the extended pair."""
    start = time.perf_counter()
    method = cell.reading.method
    if method in matchers.PARAMETERS:
        disparity, valid = matchers.disparity(scene.left, scene.right, cell.reading)
    elif method == "prototype":
        assert cell.operator is not None
        disparity = prototype.disparity(scene.left, scene.right, cell.reading, cell.operator)
        valid = np.ones(disparity.shape, bool)
    else:
        found = _core(cell, scene, advance)
        disparity, valid = found.disparity, found.valid.copy()
    if blank := cell.reading.blank:
        inside = np.zeros_like(valid)
        inside[blank:-blank, blank:-blank] = True
        valid = valid & inside
    return Found(disparity, valid, time.perf_counter() - start)


def _core(cell: Cell, scene: Scene, advance: Advance | None) -> DisparityMap:
    config = cell.config
    margins = Margins.of(cell.reading, config)
    left, right = margins.extend(scene.left), margins.extend(scene.right)
    if cell.engine == "float":
        found = float_model.disparity(left, right, config, label=cell.reading.label)
    elif cell.engine == "fixed":
        found = fixed_model.disparity(left, right, config)
    else:
        from softdepth.sim.frames import run_frames

        found = run_frames(config, [(left, right)], progress=advance).maps[0]
    return margins.crop(found)


def rmse(found: Found, reading: Reading, scene: Scene) -> float:
    """The paper's RMSE, drawn and scored as `reading` says."""
    gray = scene.truths[reading.truth].gray
    return paper_rmse(found.disparity, gray, valid=found.valid, first=reading.first)


def metrics(found: Found, reading: Reading, scene: Scene) -> Metrics:
    """The field's metrics, in the map's own view."""
    return evaluate(found.disparity, scene.truths[reading.view], valid=found.valid)
