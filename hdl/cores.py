"""The core that a configuration describes."""

from softdepth.hdl.built import check_built
from softdepth.hdl.core import StereoCore
from softdepth.hdl.whole_core import WholeFrameCore
from softdepth.spec.config import Config


def core_of(config: Config) -> StereoCore | WholeFrameCore:
    """Its core, a component with the streams ``i`` and ``o`` and the port ``status``.

    Raises `ConfigError` for a configuration that has a model but no gateware.
    """
    check_built(config)
    return WholeFrameCore(config) if config.whole_frame else StereoCore(config)
