"""Confidence: how much better a winner is than the best candidate that is not its neighbour.

``min(255, (runner_up - cost) >> Config.confidence_shift)``, and 0 where there is no runner-up. The margin
is a difference of costs as numbers (`Config.number_range`).
"""

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.winners.frame import Winners
from softdepth.spec.config import CONFIDENCE_BITS, Config


def confidence(config: Config, found: Winners) -> NDArray[np.uint8]:
    """For every pixel, rows x columns: that of its winner, whether or not the winner is kept."""
    margin = np.where(found.runner_up == found.never, 0, found.runner_up - found.at)
    scaled = np.floor(margin / (1 << config.confidence_shift))
    return np.clip(scaled, 0, (1 << CONFIDENCE_BITS) - 1).astype(np.uint8)
