"""The costs that a configuration describes."""

from amaranth.lib import data

from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.costs.comparison import by_windows
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.hdl.front.overlap import from_zero
from softdepth.spec.config import Config


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
