"""When the results of a core with a border band leave it: how many clocks after the pixel they need."""

from dataclasses import dataclass

from softdepth.hdl.asked import asked
from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.front.front import Front
from softdepth.hdl.memory.item_queue import waiting_time
from softdepth.hdl.rooms import band_winners
from softdepth.spec.config import Config


@dataclass(frozen=True)
class BandLatency:
    """Of `config`'s core, from the clock in which a pixel is taken to that in which its result can be.

    The result of (x, y) follows the pixel at (x + reach_right, y + reach_rows), the last that it needs.

    Members
    -------
    idle : clocks where that pixel finds the core idle.
    full_rate : clocks where pixels are always on offer: those wait for the steps of the ones before them.
    waiting : pixels that can wait for their first step.
    results : those that can wait at the core's end.
    """

    idle: int
    full_rate: int
    waiting: int
    results: int

    @classmethod
    def of(cls, config: Config) -> "BandLatency":
        """Derived from what the core's blocks state."""
        with asked():
            return cls._of_blocks(config)

    @classmethod
    def _of_blocks(cls, config: Config) -> "BandLatency":
        front, costs = Front(config), BandCosts(config)
        winners = band_winners(config, costs)
        idle = Front.latency + BandCosts.waits + winners.latency
        queues = front.places, costs.places
        full_rate = idle + sum(waiting_time(places, config.steps) for places in queues)
        return cls(idle, full_rate, sum(queues), winners.queue_depth)
