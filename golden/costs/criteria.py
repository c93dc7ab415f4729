"""The criteria of a candidate: the numbers that say how unlike two windows are."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.sad import Planes, sad
from softdepth.spec.config import Config, Sad

Values = NDArray[np.int32]

EVALUATE: Mapping[str, Callable[[Any, Planes, Planes], Values]] = {"sad": sad}
"""The function of each `kind` of criterion: (criterion, left, right) -> values.

It gets its own support only, blocks that exceed the result by the criterion's radius on each side.
"""


def evaluate(config: Config, left: Planes, right: Planes) -> list[Values]:
    """All criteria of the pixels whose supports fill two blocks of one shape.

    Blocks are channels x (rows + 2*reach_rows) x (reach_left + columns + reach_right), `right`
    already shifted by the candidate. Each result is rows x columns.
    """
    _, height, width = left.shape
    rows = height - 2 * config.reach_rows
    columns = width - config.reach_left - config.reach_right
    values = []
    for criterion in config.criteria:
        assert isinstance(criterion, Sad)
        r = criterion.radius
        top = config.reach_rows - r
        start = config.reach_left + criterion.dx - r
        part = np.s_[:, top : top + rows + 2 * r, start : start + columns + 2 * r]
        values.append(EVALUATE[criterion.kind](criterion, left[part], right[part]))
    return values


def compensate(config: Config, d: int, values: list[Values], replacement: list[int]) -> list[Values]:
    """The compensating rule: ``if d >= min_disparity and SAD > threshold, s_i := replacement_i``.

    SAD is that of `Config.compensation_criterion`, compared before anything saturates (paper,
    section 4, step 3).
    """
    rule = config.compensation
    if rule.reading == "off" or d < rule.min_disparity:
        return values
    assert config.compensation_criterion is not None  # the configuration has checked it
    fires = values[config.compensation_criterion] > rule.threshold
    return [np.where(fires, np.int32(r), s) for s, r in zip(values, replacement, strict=True)]
