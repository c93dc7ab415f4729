"""A frame's winners as maps in the user's reference view, one after each stage of `stages`."""

import numpy as np

from softdepth.golden.front.borders import validity_codes
from softdepth.golden.front.overlap import from_zero, placed
from softdepth.golden.front.pair import Image
from softdepth.golden.front.views import from_core_view
from softdepth.golden.maps import DisparityMap
from softdepth.golden.post.confidence import confidence
from softdepth.golden.post.stages import stages
from softdepth.golden.winners.frame import Winners
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def stage_maps(config: Config, found: Winners, reference: Image, width: int) -> dict[str, DisparityMap]:
    """By name, in order.

    Parameters
    ----------
    found, reference : winners and the reference view, in the core's view as `front.overlap` makes it.
    width : of the user's images.
    """
    inner = from_zero(config)
    height, columns, _ = reference.shape
    done = stages(inner, found, validity_codes(height, columns, inner), reference, config.pixel.bits)
    sure = confidence(inner, found) if config.post.confidence else None
    maps, fraction_bits = {}, 0
    for stage in done:
        if stage.name == "sixteenths":
            fraction_bits = config.post.fraction_bits
        measured = stage.code < Validity.BORDER
        kept = None if sure is None else np.where(measured, sure, np.uint8(0))
        after = DisparityMap(stage.disparity, stage.code, fraction_bits, kept)
        maps[stage.name] = from_core_view(placed(after, config, width), config)
    return maps
