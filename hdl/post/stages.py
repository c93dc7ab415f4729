"""The stages behind the winners, in their order."""

from softdepth.hdl.arithmetic.colour import coarse_like
from softdepth.hdl.costs.comparison import LIKE_BITS, by_windows
from softdepth.hdl.front.overlap import from_zero
from softdepth.hdl.memory.folded_memory import clocks_of
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.masked_medians import MaskedMedians
from softdepth.hdl.post.median import Median
from softdepth.hdl.post.placed import Placed
from softdepth.hdl.post.stage import PostStage
from softdepth.hdl.signatures import colour_size
from softdepth.hdl.thresholds import threshold
from softdepth.hdl.winners.layout import post_layout
from softdepth.spec.config import Config
from softdepth.spec.post import MEDIAN_REACH

MASKED_MEDIANS = "masked_medians"
"""The name of the stage that compares colours: behind it, results have none."""


def post_stages(config: Config) -> dict[str, PostStage]:
    """By name: the first takes `post_layout`, the results of either kind of winners.

    The left-right check, fractions and confidence belong to the winners, which know the costs.
    """
    shifted, config = config, from_zero(config)
    post, folds = config.post, clocks_of(config.steps)
    size = (config.result_bits, colour_size(config))
    stages: dict[str, PostStage] = {}
    if post.island:
        rows, columns = post.island_reach
        stages["island"] = Island(
            *size, config.max_width, post.island, rows=rows, columns=columns, clocks=folds
        )
    if post.fill:
        stages["fill"] = Fill(*size, config.max_width)
    if post.median:
        reach = {"rows": MEDIAN_REACH, "columns": MEDIAN_REACH}
        stages["median"] = Median(*size, config.max_width, **reach, holes=not post.fill, clocks=folds)
    if post.masked_median:
        stages[MASKED_MEDIANS] = masked_medians_of(config)
    if shifted.min_disparity and not by_windows(shifted):
        colours = 0 if post.masked_median else colour_size(config)
        stages["placed"] = Placed(shifted, post_layout(config.result_bits, colours))
    return stages


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
