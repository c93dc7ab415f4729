"""Speed per operator: both models in one run, and the clocks of the gateware."""

import json
import platform
import time
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel

from softdepth.golden import fixed_model, float_model
from softdepth.spec.config import OPERATORS, Operator
from softdepth.spec.errors import InputError
from softdepth.studies.paper.readings import MULTIPLIERS, Reading
from softdepth.studies.paper.scenes import Scene

ROWS, REPEATS = 32, 11
"""Rows of a scene that are timed, and how often; the operators take turns, the best time counts."""

TIE = 1.05
"""Times that differ by less than this are one: what repeated runs differ by."""

LANES = 64


class Speed(BaseModel):
    """One operator's speed.

    Members
    -------
    float_ns, fixed_ns : nanoseconds of processor time a pixel, on one core.
    lanes, clocks : the most lanes that the multipliers of the target allow, and their clocks a pixel.
    multipliers : what these lanes take.
    luts_per_lane : LUT4 of a lane of `paper` on ECP5, from ``docs/area.json``, or None: not measured.
    """

    operator: Operator
    float_ns: float
    fixed_ns: float
    lanes: int
    clocks: int
    multipliers: int
    luts_per_lane: float | None = None


class Speeds(BaseModel):
    """The speed of all operators, and the processor that gave the models' times."""

    processor: str
    rows: int
    multipliers: int
    operators: list[Speed]

    def fastest(self, engine: Literal["float", "fixed"]) -> Operator:
        """The operator that a model computes fastest."""
        return min(self.operators, key=lambda s: getattr(s, f"{engine}_ns")).operator

    @property
    def fewest_clocks(self) -> list[Operator]:
        """The operators with the fewest clocks a pixel in gateware."""
        least = min(s.clocks for s in self.operators)
        return [s.operator for s in self.operators if s.clocks == least]


def measure(scene: Scene, reading: Reading) -> Speeds:
    """Time every operator on some rows of `scene`."""
    left, right = scene.left[:ROWS], scene.right[:ROWS]
    pixels = left.shape[0] * left.shape[1]
    best: dict[tuple[Operator, str], float] = {}
    for _ in range(REPEATS):
        for operator in OPERATORS:
            config = reading.config(operator)
            for name, model in (("float", float_model.disparity), ("fixed", fixed_model.disparity)):
                start = time.process_time()
                model(left, right, config)
                seconds = time.process_time() - start
                best[operator, name] = min(seconds, best.get((operator, name), np.inf))
    return Speeds(
        processor=processor(),
        rows=ROWS,
        multipliers=MULTIPLIERS,
        operators=[
            Speed(
                operator=operator,
                float_ns=1e9 * best[operator, "float"] / pixels,
                fixed_ns=1e9 * best[operator, "fixed"] / pixels,
                **_gateware(reading, operator),
            )
            for operator in OPERATORS
        ],
    )


def _gateware(reading: Reading, operator: Operator) -> dict[str, int]:
    config = reading.config(operator, lanes=LANES)
    return {"lanes": config.lanes, "clocks": config.steps, "multipliers": config.multipliers}


def with_luts(speeds: Speeds, area: Path) -> Speeds:
    """`speeds` with ``luts_per_lane`` from ``docs/area.json``, if the file is there.

    Raises `InputError` for a file that cannot be read.
    """
    if not area.exists():
        return speeds
    try:
        lanes: dict[str, dict[str, int]] = json.loads(area.read_text())["lanes"]
        known = [
            s.model_copy(update={"luts_per_lane": lanes[s.operator]["lut4"] if s.operator in lanes else None})
            for s in speeds.operators
        ]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"cannot read '{area}': {error}", "make it again, or remove it") from error
    return speeds.model_copy(update={"operators": known})


def processor() -> str:
    """The processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
