"""Lower medians of samples that may be missing."""

import numpy as np
from numpy.typing import NDArray

MISSING = np.uint16(np.iinfo(np.uint16).max)
"""A sample that does not count: it sorts after all others."""


def lower_median(samples: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """The sample of rank ``(n - 1) // 2`` in the last axis, where n counts those that are not `MISSING`.

    If all are missing, it is `MISSING`.
    """
    ordered = np.sort(samples, axis=-1)
    count = np.count_nonzero(samples != MISSING, axis=-1)
    rank = np.maximum(count - 1, 0) >> 1
    return np.take_along_axis(ordered, rank[..., None], axis=-1)[..., 0]
