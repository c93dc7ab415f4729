"""Candidates that do not begin at 0 (`Config.min_disparity`), reduced to candidates that do.

Candidate d of a pair is candidate ``d - min_disparity`` of the same pair with the other view moved right by
`min_disparity`. After that, the views overlap in all but ``abs(min_disparity)`` columns. The others have no
result: the left ones of the reference view if it is positive, the right ones if it is negative.
"""

import numpy as np

from softdepth.golden.front.pair import Image
from softdepth.golden.maps import DisparityMap
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def from_zero(config: Config) -> Config:
    """The same method with candidates from 0 on, for views as `overlap` gives them."""
    shift = config.min_disparity
    if not shift:
        return config
    rule = config.compensation
    moved = rule.model_copy(update={"from_disparity": rule.from_disparity - shift})
    return config.model_copy(update={"min_disparity": 0, "compensation": moved})


def overlap(reference: Image, other: Image, config: Config) -> tuple[Image, Image]:
    """The columns in which the views overlap, HxWxC in the core's view; none in narrow images."""
    shift, width = config.min_disparity, reference.shape[1]
    kept = max(width - abs(shift), 0)
    first = first_column(config)
    return reference[:, first : first + kept], other[:, max(-shift, 0) :][:, :kept]


def first_column(config: Config) -> int:
    """The reference view's column in which the overlap begins."""
    return max(config.min_disparity, 0)


def placed(found: DisparityMap, config: Config, width: int) -> DisparityMap:
    """The overlap's map placed in the frame, `width` columns wide, with the true disparities."""
    shift = config.min_disparity
    if not shift:
        return found
    kind = np.int16 if shift < 0 else np.uint16
    before = min(first_column(config), width)
    after = width - before - found.shape[1]
    columns = ((0, 0), (before, after))
    units = np.int32(shift << found.fraction_bits)
    disparity = np.where(found.given, found.disparity + units, 0).astype(kind)
    sure = found.confidence
    return DisparityMap(
        np.pad(disparity, columns),
        np.pad(found.code, columns, constant_values=Validity.BORDER),
        found.fraction_bits,
        None if sure is None else np.pad(sure, columns),
    )
