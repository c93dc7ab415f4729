"""Where a result's pixel of the left view comes from."""

from dataclasses import dataclass
from typing import Literal

from softdepth.hdl.asked import asked
from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.costs.comparison import by_windows
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY
from softdepth.hdl.post.stages import MASKED_MEDIANS, masked_medians_of
from softdepth.hdl.whole_latency import WholeLatency
from softdepth.spec.config import Config

Origin = Literal["results", "masked_medians", "guard"]


@dataclass(frozen=True)
class LeftPixels:
    """Of `config`'s core: from as late as can be, because all pixels between there and the output are kept.

    Members
    -------
    origin : ``results`` have them up to the core's output; up to the stage ``masked_medians``; or nothing
        behind the ``guard`` has them: those of windows of pixels, and where the views' overlap is moved or
        colours lose bits.
    places : pixels that are kept at a time, at least: as many as come in before the first one's result is
        there, at full rate. With fewer than the result waits for, the core would wait for itself.
    """

    origin: Origin
    places: int

    @classmethod
    def of(cls, config: Config) -> "LeftPixels":
        """Derived from what the core's blocks state."""
        width = config.max_width
        if by_windows(config):
            band = BandLatency.of(config)
            seen = config.reach_rows * width + config.reach_right
            return cls("guard", seen + _during(band.idle + QUEUE_LATENCY, config.steps, waiting=band.waiting))
        if config.min_disparity or config.colour_bits < config.pixel.bits:
            whole = WholeLatency.of(config)
            return cls(
                "guard",
                whole.rows * width + whole.column + _during(whole.clocks + QUEUE_LATENCY, config.steps),
            )
        if config.post.masked_median:
            with asked():
                time = masked_medians_of(config).time
            return cls(MASKED_MEDIANS, time.rows * width + time.columns + _during(time.behind, time.clocks))
        return cls("results", 0)


def _during(clocks: int, steps: int, *, waiting: int = ItemQueue.places) -> int:
    """Pixels in flight: those that wait, and those that come within so many clocks."""
    return -(-clocks // steps) + 1 + waiting
