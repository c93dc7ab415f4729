"""Full coverage without padding in the core: the host extends the pair, and crops the map."""

from dataclasses import dataclass

import numpy as np

from softdepth.golden.maps import DisparityMap
from softdepth.spec.config import Config
from softdepth.studies.paper.readings import Reading


@dataclass(frozen=True)
class Margins:
    """Pixels that are added around a pair, by replicating its edges."""

    rows: int
    left: int
    right: int

    @classmethod
    def of(cls, reading: Reading, config: Config) -> "Margins":
        """What `reading` needs, so that the border rule of the core gives its border.

        On the side where candidates leave the other image, the margin covers them all where they
        read its replicated edge. There is none where they are excluded with their window.
        """
        near = config.reach_left + config.disparities - 1 if reading.leaving == "replicated" else 0
        sides = (near, config.reach_right)
        left, right = sides if config.reference == "left" else sides[::-1]
        return cls(config.reach_rows, left, right)

    def extend(self, image: np.ndarray) -> np.ndarray:
        """`image` (H x W x 3) with its margins."""
        return np.pad(image, ((self.rows, self.rows), (self.left, self.right), (0, 0)), mode="edge")

    def crop(self, found: DisparityMap) -> DisparityMap:
        """A map of the extended pair, at the pair's own size."""
        height, width = found.shape
        inside = np.s_[self.rows : height - self.rows, self.left : width - self.right]
        return DisparityMap(found.disparity[inside], found.code[inside])
