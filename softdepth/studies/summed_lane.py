"""One lane of a core that sums down columns, by itself."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.comparison import plan
from softdepth.hdl.costs.criteria.running_sums import RunningSums
from softdepth.hdl.costs.whole_lane import LaneDifferences, LaneSums
from softdepth.spec.config import Config


class SummedLane(wiring.Component):
    """Everything that judges one candidate, as `WholeCosts` connects it: to be measured, not to be run.

    Members
    -------
    Those of `LaneDifferences`, `RunningSums` and `LaneSums` that come from without, and
    o : the candidate's cost.
    """

    def __init__(self, config: Config) -> None:
        found = plan(config)
        self._differences = LaneDifferences(found)
        self._running = RunningSums(
            [c.column_maximum for c in found.columns],
            [c.pixel_maximum for c in found.columns],
            config.places,
        )
        self._sums = LaneSums(config, found)
        outer = {
            self._differences: ("left", "right", "absent", "new_inside", "old_inside"),
            self._running: ("valid", "place", "begins", "outside"),
            self._sums: ("supports", "near"),
        }
        self._outer = [(block, name) for block, names in outer.items() for name in names]
        ports = {name: In(block.signature.members[name].shape) for block, name in self._outer}
        super().__init__({**ports, "sums": In(1), "o": Out(self._sums.layout)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.differences = differences = self._differences
        m.submodules.running = running = self._running
        m.submodules.sums = sums = self._sums
        m.d.comb += [getattr(block, name).eq(getattr(self, name)) for block, name in self._outer]
        m.d.comb += [
            running.new.as_value().eq(differences.new.as_value()),
            running.old.as_value().eq(differences.old.as_value()),
            sums.valid.eq(self.sums),
            sums.columns.as_value().eq(running.o.as_value()),
            self.o.eq(sums.o),
        ]
        return m
