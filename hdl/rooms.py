"""The rooms that a configuration describes: front, costs and winners, of one of two kinds.

Criteria over windows of plain pixels leave a border band; all others are summed from descriptors, over whole
frames.
"""

from amaranth.lib import data

from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.costs.comparison import by_windows, plan
from softdepth.hdl.costs.cost import fraction_layout
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.hdl.front.descriptors import Descriptors
from softdepth.hdl.front.front import Front
from softdepth.hdl.front.overlap import from_zero
from softdepth.hdl.memory.folded_memory import clocks_of
from softdepth.hdl.signatures import colour_size
from softdepth.hdl.winners.band_winners import BandWinners
from softdepth.hdl.winners.whole_winners import WholeWinners
from softdepth.spec.config import Config


def front_of(config: Config, *, left: int = 0) -> Front:
    """A component that gives what `costs_of` compares.

    Parameters
    ----------
    left : as of `Front`.
    """
    if by_windows(config):
        return Front(config, left=left)
    pixel, needs = config.pixel, plan(config)
    descriptors = Descriptors(
        pixel.channels,
        pixel.bits,
        config.max_width,
        colour_bits=pixel.bits if needs.has_support else config.colour_bits,
        descriptors=tuple(needs.descriptors.values()),
        rows=needs.rows,
        after=needs.below,
        clocks=clocks_of(config.steps),
    )
    return Front(config, descriptors, left=left)


def costs_of(config: Config, compared: data.StructLayout) -> BandCosts | WholeCosts:
    """A component that takes the front's stream and has `cost_ports`.

    Parameters
    ----------
    compared : what the front gives for each pixel.
    """
    if by_windows(config):
        return BandCosts(config)
    return WholeCosts(from_zero(config), compared, config.pixel.channels, drain=drain_of(config))


def drain_of(config: Config) -> int:
    """Slots behind a frame, in which the right view's winners of its last columns leave."""
    return config.disparities - 1 if config.post.check else 0


def winners_of(config: Config, costs: BandCosts | WholeCosts) -> BandWinners | WholeWinners:
    """A component with `winner_ports` that match `costs`, and the stream ``o`` of results."""
    if isinstance(costs, WholeCosts):
        return WholeWinners(from_zero(config), costs.layout, colour_size(config), costs.latency)
    return band_winners(config, costs)


def band_winners(config: Config, costs: BandCosts) -> BandWinners:
    """The same of criteria that have a border band."""
    return BandWinners(config, fraction_layout(config), ahead=costs.latency, tags_ahead=costs.tags_ahead)
