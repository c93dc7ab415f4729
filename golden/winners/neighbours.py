"""The costs of the candidates beside the winner, from which fractions of a pixel are computed."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def neighbours(volume: Array, winner: NDArray[np.uint16], never: Any) -> tuple[Array, Array, Array]:
    """Costs at d - 1, d and d + 1 of the winner d.

    `volume` is candidates x rows x columns, `never` where a candidate is excluded; so is what lies
    beyond the first and the last candidate.
    """
    last = len(volume) - 1
    d = winner.astype(np.intp)[None]

    def at(index: NDArray[np.intp]) -> Array:
        there = np.take_along_axis(volume, np.clip(index, 0, last), axis=0)
        return np.where((index >= 0) & (index <= last), there, never)[0]

    return at(d - 1), at(d), at(d + 1)
