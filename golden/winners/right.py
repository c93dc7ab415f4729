"""The right winner: the candidate of least cost for every pixel of the other view.

Pixel x of the right view is matched at candidate d by pixel x + d of the left. Pixels beyond the end of the
row are not candidates. On a tie the smallest d wins.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.winners.cost import Comparison, Cost


class Right:
    """As `left.Left`, for the pixels of the right view."""

    def __init__(self, shape: tuple[int, int], comparison: Comparison) -> None:
        self._beats = comparison.beats
        self.winner = np.zeros(shape, np.uint16)
        self.best: tuple[NDArray[Any], ...] = ()

    def take(self, d: int, cost: Cost) -> None:
        """Candidate d of the left view's pixels from column d on: their partners start at column 0."""
        if not self.best:
            self.best = tuple(part.copy() for part in cost)
            return
        partners = slice(0, self.winner.shape[1] - d)
        best = [part[:, partners] for part in self.best]
        better = self._beats(cost, best)
        for part, new in zip(best, cost, strict=True):
            np.copyto(part, new, where=better)
        self.winner[:, partners][better] = d
