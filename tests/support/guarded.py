"""The guard that tests of it feed, and what leaves it."""

from softdepth.hdl.front.frame_guard import FrameGuard
from softdepth.hdl.front.silence import silent_clocks
from tests.support.simulation import Transfers, config, sad, stream_through

MAX_WIDTH = 10
MAX_HEIGHT = 8
CONFIG = config(
    cost="sum", criteria=[sad(3)], disparities=4, lanes=2, max_width=MAX_WIDTH, max_height=MAX_HEIGHT
)
MIN_WIDTH = CONFIG.min_width
PATIENCE = 2 * silent_clocks(CONFIG)

RATES = [(1.0, 1.0), (0.5, 1.0), (0.7, 0.6)]


def guarded(transfers: list[int], rates: tuple[float, float], seed: int = 1) -> Transfers:
    return stream_through(
        FrameGuard(CONFIG), transfers, i_rate=rates[0], o_rate=rates[1], seed=seed, patience=PATIENCE
    )
