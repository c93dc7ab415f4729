"""A lane: everything that judges one candidate."""

from collections.abc import Callable
from typing import Any

from amaranth.hdl import Module, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.costs.cost import COSTS, fraction_layout
from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.criteria.criterion import CriterionBlock
from softdepth.hdl.costs.criteria.sad import SadCriteria
from softdepth.hdl.memory.delay import delayed
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import Config
from softdepth.spec.registry import Registry

CRITERIA: Registry[Callable[[Config, list[Any]], CriterionBlock]] = Registry("criterion's gateware")
"""The block that computes each kind of criterion; all of a kind in a lane share one."""

CRITERIA.register("sad", SadCriteria)


def column_layout(config: Config) -> data.ArrayLayout:
    """The pixels of a column that lanes receive, top first: as many rows as any criterion compares."""
    return data.ArrayLayout(pixel_layout(config.pixel), config.column_rows)


class Lane(wiring.Component):
    """Judges one candidate a clock: its criteria, then its cost.

    Members
    -------
    valid : the columns are a step of a pixel.
    coming, place : the columns that come in `look_ahead` clocks are a step; which one of the line's.
    left, right : the columns to compare.
    near : input of the cost, ``criteria_latency`` clocks after the columns.
    o : the candidate's cost, `latency` clocks after the columns.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._cost = COSTS[config.cost](config)
        self._criteria = {
            kind: CRITERIA[kind](config, [c for c in config.criteria if c.kind == kind])
            for kind in sorted({c.kind for c in config.criteria})
        }
        self.look_ahead = max(block.look_ahead for block in self._criteria.values())
        self.criteria_latency = max(block.latency for block in self._criteria.values())
        self.latency = self.criteria_latency + self._cost.latency
        super().__init__(
            {
                "valid": In(1),
                "coming": In(1),
                "place": In(range(config.places)),
                "left": In(column_layout(config)),
                "right": In(column_layout(config)),
                "near": In(1),
                "o": Out(fraction_layout(config)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.cost = self._cost
        values = Signal(criteria_layout(self._config.maxima))
        for kind, block in self._criteria.items():
            m.submodules[kind] = block
            own = max(c.reach_rows for c in self._config.criteria if c.kind == kind)
            below = self._config.reach_rows - own  # rows that only other criteria see
            stop = self._config.column_rows - below
            rows = range(stop - block.left.shape().length, stop)
            m.d.comb += [
                block.valid.eq(self.valid),
                *self._announced(m, kind),
                *(block.left[k].eq(self.left[row]) for k, row in enumerate(rows)),
                *(block.right[k].eq(self.right[row]) for k, row in enumerate(rows)),
            ]
            aligned = block.o
            for stage in range(self.criteria_latency - block.latency):
                register = Signal(block.o.shape(), name=f"{kind}_{stage}", reset_less=True)
                m.d.sync += register.eq(aligned)
                aligned = register
            mine = (i for i, c in enumerate(self._config.criteria) if c.kind == kind)
            for k, i in enumerate(mine):
                m.d.comb += values[f"s{i}"].eq(aligned[f"s{k}"])
        m.d.comb += [
            self._cost.near.eq(self.near),
            self._cost.i.eq(values),
            self.o.eq(self._cost.o),
        ]
        return m

    def _announced(self, m: Module, kind: str) -> list[Any]:
        """Statements that announce the coming columns to a kind's criteria, as early as these want it."""
        block = self._criteria[kind]
        late = self.look_ahead - block.look_ahead
        coming = travelling(m, self.coming, late, f"{kind}_coming")[-1]
        return [block.coming.eq(coming), block.place.eq(delayed(m, self.place, late, f"{kind}_place"))]
