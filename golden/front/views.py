"""From the user's reference view to the core's, and back.

The core refers to the left view: candidate d compares ``L(x, y)`` with ``R(x - d, y)``. The paper's
eq. 7 prints the other form, ``x + d``. A mirrored right view is a left view, so that form is the same core,
fed with the pair swapped and mirrored, and its result mirrored back.
"""

import numpy as np

from softdepth.golden.front.pair import Image
from softdepth.golden.maps import DisparityMap
from softdepth.spec.config import Config


def to_core_view(left: Image, right: Image, config: Config) -> tuple[Image, Image]:
    """The pair as the core sees it, reference first: HxWxC (or HxW gray) in, HxWxC out.

    A criterion's ``dx`` counts in this view: with the right reference it points left in the user's.
    """
    left, right = (image if image.ndim == 3 else image[:, :, np.newaxis] for image in (left, right))
    if config.reference == "right":
        return right[:, ::-1], left[:, ::-1]
    return left, right


def from_core_view(result: DisparityMap, config: Config) -> DisparityMap:
    """The core's map in the user's reference view."""
    return result.mirrored() if config.reference == "right" else result


def column_in_core_view(x: int, width: int, config: Config) -> int:
    """The core's column of the user's column `x`, in images `width` pixels wide."""
    return width - 1 - x if config.reference == "right" else x
