"""Which pixels have a result: the border rule."""

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def validity_codes(height: int, width: int, config: Config) -> NDArray[np.uint8]:
    """The `Validity` of every pixel of a height x width frame, in the core's view.

    Nothing is padded. `BORDER`: the support (all criteria together) leaves the reference image.
    `PARTIAL`: it leaves the other image for some candidate d, because x - reach_left - d < 0.
    """
    x = np.arange(width)
    y = np.arange(height)
    columns = (x >= config.reach_left) & (x < width - config.reach_right)
    rows = (y >= config.reach_rows) & (y < height - config.reach_rows)
    partial = x - config.reach_left < config.disparities - 1
    inside = np.where(partial, Validity.PARTIAL, Validity.FULL)
    return np.where(rows[:, None] & columns, inside, Validity.BORDER).astype(np.uint8)
