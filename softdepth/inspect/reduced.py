"""A pair, gray and small enough to be measured in a fraction of a second."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np

LONGEST_SIDE = 800
"""Pixels. Keypoints are found to a tenth of a pixel: a row of offset still shows at a third of the size."""


@dataclass(frozen=True, eq=False)
class Reduced:
    """Two gray views of one size, and how many pixels of the originals one of theirs is.

    Parameters
    ----------
    left, right : uint8 H x W.
    scale : 1 or more: lengths in the originals are `scale` times as long.
    """

    left: np.ndarray
    right: np.ndarray
    scale: float

    @classmethod
    def of(cls, left: np.ndarray, right: np.ndarray, longest: int = LONGEST_SIDE) -> Self:
        """Two uint8 RGB images (H x W x 3) or gray ones (H x W), averaged down to `longest` pixels a side."""
        height, width = left.shape[:2]
        scale = max(1.0, max(height, width) / longest)
        size = max(1, round(width / scale)), max(1, round(height / scale))
        reduced = [_gray(view) for view in (left, right)]
        if scale > 1:
            reduced = [cv2.resize(view, size, interpolation=cv2.INTER_AREA) for view in reduced]
        return cls(reduced[0], reduced[1], scale)

    def smaller(self, longest: int) -> "Reduced":
        """The same pair with at most `longest` pixels a side."""
        again = Reduced.of(self.left, self.right, longest)
        return Reduced(again.left, again.right, self.scale * again.scale)

    @property
    def height(self) -> int:
        """Rows."""
        return self.left.shape[0]

    @property
    def width(self) -> int:
        """Columns."""
        return self.left.shape[1]


def _gray(view: np.ndarray) -> np.ndarray:
    return view if view.ndim == 2 else cv2.cvtColor(view, cv2.COLOR_RGB2GRAY)
