"""The left winner: the candidate of least cost for every pixel of the reference view.

On a tie the smallest d wins: candidates come in ascending order, and a later one must be strictly better.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.winners.cost import Comparison, Cost


class LeftWinner:
    """The best candidate so far of rows x columns pixels: `winner`, and its cost `best`."""

    def __init__(self, shape: tuple[int, int], comparison: Comparison) -> None:
        self._beats = comparison.beats
        self.winner = np.zeros(shape, np.uint16)
        self.best: tuple[NDArray[Any], ...] = ()

    def columns(self, d: int) -> slice:
        """The columns of the pixels that candidate d is offered to: in the first d it has no partner."""
        return slice(d, None)

    def take(self, d: int, cost: Cost) -> None:
        """Candidate d, with its cost in the reference view's columns from d on; d = 0 comes first."""
        if not self.best:
            self.best = tuple(part.copy() for part in cost)
            return
        columns = self.columns(d)
        best = [part[:, columns] for part in self.best]
        better = self._beats(cost, best)
        for part, new in zip(best, cost, strict=True):
            np.copyto(part, new, where=better)
        self.winner[:, columns][better] = d
