"""The costs that a configuration describes."""

from amaranth.lib import data

from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.spec.config import Config


def costs_of(config: Config, compared: data.StructLayout) -> BandCosts | WholeCosts:
    """A component that takes the front's stream and has `cost_ports`.

    Parameters
    ----------
    compared : what the front gives of each pixel.
    """
    if not config.whole_frame:
        return BandCosts(config)
    # The right view's winners of a line's last columns leave in slots of their own.
    drain = config.disparities - 1 if config.post.check else 0
    return WholeCosts(config, compared, config.pixel.channels, drain=drain)
