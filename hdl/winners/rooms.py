"""The winners that a configuration describes."""

from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.costs.cost import fraction_layout
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.hdl.front.overlap import from_zero
from softdepth.hdl.signatures import colour_size
from softdepth.hdl.winners.band_winners import BandWinners
from softdepth.hdl.winners.whole_winners import WholeWinners
from softdepth.spec.config import Config


def winners_of(config: Config, costs: BandCosts | WholeCosts) -> BandWinners | WholeWinners:
    """A component with `winner_ports` that match `costs`, and the stream ``o`` of results."""
    if isinstance(costs, WholeCosts):
        return WholeWinners(from_zero(config), costs.layout, colour_size(config), costs.latency)
    return band_winners(config, costs)


def band_winners(config: Config, costs: BandCosts) -> BandWinners:
    """The same of criteria that have a border band."""
    return BandWinners(config, fraction_layout(config), ahead=costs.latency, tags_ahead=costs.tags_ahead)
