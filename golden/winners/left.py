"""The left winner: the candidate of least cost for every pixel of the reference view.

On a tie the smallest d wins: candidates come in ascending order, and a later one must be strictly better.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.winners.cost import Comparison, Cost


class Left:
    """The best candidate so far of rows x columns pixels: `winner`, and its cost `best`."""

    def __init__(self, shape: tuple[int, int], comparison: Comparison) -> None:
        self._beats = comparison.beats
        self.winner = np.zeros(shape, np.uint16)
        self.best: tuple[NDArray[Any], ...] = ()

    def take(self, d: int, cost: Cost) -> None:
        """Candidate d, of which the first d columns have none; d = 0 comes first."""
        if not self.best:
            self.best = tuple(part.copy() for part in cost)
            return
        best = [part[:, d:] for part in self.best]
        better = self._beats(cost, best)
        for part, new in zip(best, cost, strict=True):
            np.copyto(part, new, where=better)
        self.winner[:, d:][better] = d
