"""One lane of a core that sums down columns, by itself."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.column_groups import join_columns
from softdepth.hdl.costs.comparison import plan
from softdepth.hdl.costs.whole_lane import LaneDifferences, LaneSums
from softdepth.spec.config import Config


class SummedLane(wiring.Component):
    """Everything that judges one candidate, as `WholeCosts` connects it: to be measured, not to be run.

    Members
    -------
    Those of `LaneDifferences`, `join_columns` and `LaneSums` that come from outside, and
    o : the candidate's cost.
    """

    def __init__(self, config: Config) -> None:
        self._config, self._plan = config, plan(config)
        self._differences = LaneDifferences(self._plan)
        self._sums = LaneSums(config, self._plan)
        outer = {
            self._differences: ("left", "right", "absent", "inside"),
            self._sums: ("full", "supports", "near"),
        }
        self._outer = [(block, name) for block, names in outer.items() for name in names]
        ports = {name: In(block.signature.members[name].shape) for block, name in self._outer}
        flags = {name: In(1) for name in ("valid", "begins", "outside", "summed", "line_begins")}
        super().__init__({**ports, **flags, "place": In(range(config.places)), "o": Out(self._sums.layout)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.differences = differences = self._differences
        m.submodules.sums = sums = self._sums
        m.d.comb += [getattr(block, name).eq(getattr(self, name)) for block, name in self._outer]
        join_columns(
            m,
            self._config,
            self._plan,
            [differences],
            [sums],
            valid=self.valid,
            place=self.place,
            begins=self.begins,
            outside=self.outside,
            summed=self.summed,
        )
        m.d.comb += [
            sums.valid.eq(self.summed),
            sums.begins.eq(self.line_begins),
            self.o.eq(sums.o),
        ]
        return m
