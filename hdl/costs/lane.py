"""A lane: everything that judges one candidate."""

from collections.abc import Callable
from typing import Any

from amaranth.hdl import Module, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.cost import COSTS, fraction_layout
from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.criteria.sad import SadCriteria
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import Config
from softdepth.spec.registry import Registry

CRITERIA: Registry[Callable[[Config, list[Any]], Any]] = Registry("criterion's gateware")
"""The component that computes each kind of criterion. All of a kind in a lane share one."""

CRITERIA.register("sad", SadCriteria)


def column_layout(config: Config) -> data.ArrayLayout:
    """The pixels of a column that lanes compare: the support without its stored rows, top first."""
    return data.ArrayLayout(pixel_layout(config.pixel), config.column_rows)


class Lane(wiring.Component):
    """Judges one candidate a clock: its criteria, then its cost.

    Members
    -------
    valid : the columns are a step of a pixel.
    coming, place : those in `LOOKUP_AHEAD` clocks are one, and which of the line's steps.
    left, right : the columns to compare.
    near : input of the cost, ``criteria_latency`` clocks after the columns.
    o : the candidate's cost, `latency` clocks after the columns.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._cost = COSTS[config.cost](config)
        self._criteria = {
            kind: CRITERIA[kind](config, [c for c in config.sads if c.kind == kind])
            for kind in sorted({c.kind for c in config.sads})
        }
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
            m.d.comb += [
                block.valid.eq(self.valid),
                block.coming.eq(self.coming),
                block.place.eq(self.place),
                block.left.eq(self.left),
                block.right.eq(self.right),
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
