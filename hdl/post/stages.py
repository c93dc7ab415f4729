"""The stages behind the winners, in their order."""

from softdepth.hdl.arithmetic.colour import coarse_like
from softdepth.hdl.costs.comparison import LIKE_BITS
from softdepth.hdl.front.overlap import from_zero
from softdepth.hdl.memory.folded_memory import clocks_of
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.masked_medians import MaskedMedians
from softdepth.hdl.post.median import Median
from softdepth.hdl.signatures import colour_size
from softdepth.hdl.thresholds import threshold
from softdepth.spec.config import Config
from softdepth.spec.post import MEDIAN_REACH


def post_stages(config: Config) -> dict[str, Island | Fill | Median | MaskedMedians]:
    """By name: each has streams ``i`` and ``o`` of `post_layout`, for results of either kind of winners.

    The left-right check, fractions and confidence belong to the winners, which know the costs.
    """
    config = from_zero(config)
    post = config.post
    size = (config.result_bits, colour_size(config))
    stages: dict[str, Island | Fill | Median | MaskedMedians] = {}
    if post.island:
        stages["island"] = island_of(config)
    if post.fill:
        stages["fill"] = Fill(*size, config.max_width)
    if post.median:
        stages["median"] = median_of(config)
    if post.masked_median:
        stages["masked_medians"] = masked_medians_of(config)
    return stages


def island_of(config: Config) -> Island:
    """The stage of the island test."""
    post = config.post
    size = (config.result_bits, colour_size(config), config.max_width)
    rows, columns = post.island_reach
    return Island(*size, post.island, rows=rows, columns=columns, clocks=clocks_of(config.steps))


def median_of(config: Config) -> Median:
    """The stage of the median."""
    config = from_zero(config)
    reach = {"rows": MEDIAN_REACH, "columns": MEDIAN_REACH}
    size = (config.result_bits, colour_size(config), config.max_width)
    return Median(*size, **reach, holes=not config.post.fill, clocks=clocks_of(config.steps))


def masked_medians_of(config: Config) -> MaskedMedians:
    """The stage of both masked medians."""
    config = from_zero(config)
    post, pixel, kept = config.post, config.pixel, config.colour_bits
    rows, columns = post.masked_reach
    like = threshold("like", post.like) << (pixel.bits - LIKE_BITS)
    return MaskedMedians(
        config.result_bits,
        colour_size(config),
        pixel.channels,
        config.max_width,
        rows=rows,
        columns=columns,
        spacing=post.masked_step,
        like=coarse_like(like, pixel.bits - kept),
        holes=not post.fill,
        clocks=min(config.steps, 2),
    )
