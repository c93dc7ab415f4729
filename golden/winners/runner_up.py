"""The runner-up: the least cost of the candidates that are not the winner's neighbours."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def runner_up(volume: Array, winner: NDArray[np.uint16], never: Any) -> Array:
    """The least cost over all d with ``|d - winner| > 1``; `never` where no such candidate takes part.

    `volume` as in `neighbours`.
    """
    best = np.full(winner.shape, never, volume.dtype)
    distance = winner.astype(np.int32)
    for d, cost in enumerate(volume):
        far = np.abs(distance - d) > 1
        np.minimum(best, cost, out=best, where=far)
    return best
