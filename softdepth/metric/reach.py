"""The depths that a configuration can tell apart."""

import math
from dataclasses import dataclass

import numpy as np

from softdepth.rig.geometry import Geometry
from softdepth.spec.config import Config


@dataclass(frozen=True)
class Reach:
    """From where to where a core measures behind given cameras, and how finely.

    Members
    -------
    geometry : the rectified pair's.
    unit : the step of the core's disparities, in pixels.
    disparities : (smallest, largest) in pixels of those with a finite depth ahead; None where there is none.
    """

    geometry: Geometry
    unit: float
    disparities: tuple[float, float] | None

    @classmethod
    def of(cls, geometry: Geometry, config: Config) -> "Reach":
        """The reach of a configuration.

        The first and the last candidate have a neighbour on one side only, and so no fraction: fractions
        begin half a pixel from them.
        """
        one = 1 << config.post.fraction_bits
        results = np.arange(config.min_disparity * one, config.max_disparity * one + 1)
        inward = np.minimum(results - results[0], results[-1] - results)
        results = results[(inward == 0) | (inward >= one // 2)] / one
        ahead = results[results + geometry.doffs > 0]
        return cls(geometry, 1 / one, (float(ahead[0]), float(ahead[-1])) if len(ahead) else None)

    @property
    def nearest(self) -> float:
        """The smallest depth that is measured, in metres; infinite where there is none."""
        return self.geometry.distance(self.disparities[1]) if self.disparities else math.inf

    @property
    def farthest(self) -> float:
        """The largest finite depth that is measured, in metres; 0 where there is none."""
        return self.geometry.distance(self.disparities[0]) if self.disparities else 0.0

    def step(self, depth: float) -> float | None:
        """``Z^2 / (f B)`` times the disparity's step, in metres; None at a depth that is not measured."""
        if not self.nearest <= depth <= self.farthest:
            return None
        return depth**2 / self.geometry.scale * self.unit
