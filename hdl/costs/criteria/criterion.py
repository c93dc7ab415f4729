"""What a lane asks of every criterion over windows of pixels."""

from collections.abc import Iterable

from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import AnyCriterion, Config


class CriterionBlock(wiring.Component):
    """Computes all criteria of one kind in a lane, one candidate a clock.

    A new kind is a subclass that sets `latency`, and `look_ahead` if it keeps something in memory.

    Parameters
    ----------
    config : the core's configuration.
    criteria : those of this kind among its criteria, in order.
    rows : of the column that they compare, down to the newest in their own support.

    Members
    -------
    valid : the columns are a step of a pixel.
    coming, place : the columns that come in `look_ahead` clocks are a step; which one of the line's.
    left, right : the columns to compare, from the top.
    o : the values, ``latency`` clocks later, in the order of ``criteria``. They belong to the pixel
        `Config.window_right` columns before the one that entered.
    """

    latency: int
    """Clocks from the columns to the values."""
    look_ahead = 0
    """Clocks by which columns are announced before they come."""

    def __init__(self, config: Config, criteria: Iterable[AnyCriterion], rows: int) -> None:
        column = data.ArrayLayout(pixel_layout(config.pixel), rows)
        super().__init__(
            {
                "valid": In(1),
                "coming": In(1),
                "place": In(range(config.places)),
                "left": In(column),
                "right": In(column),
                "o": Out(criteria_layout(c.maximum_of(config.pixel) for c in criteria)),
            }
        )
