"""The criterion `spot` in gateware."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.lane import CRITERIA
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import AnyCriterion, Config


class SpotCriteria(wiring.Component):
    """The newest pixel's difference, held back until its pixel's turn. One candidate a clock."""

    latency = 1

    def __init__(self, config: Config, criteria: list[AnyCriterion]) -> None:
        self._depth = config.window_right * config.steps
        column = data.ArrayLayout(pixel_layout(config.pixel), 1)
        super().__init__(
            {
                "valid": In(1),
                "coming": In(1),
                "place": In(range(config.places)),
                "left": In(column),
                "right": In(column),
                "o": Out(criteria_layout(c.maximum_of(config.pixel) for c in criteria)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.hold = hold = Delay(len(self.o.s0), self._depth)
        a, b = self.left[0][0], self.right[0][0]
        difference, valid = Signal(len(self.o.s0)), Signal()
        m.d.sync += [difference.eq(Mux(a > b, a - b, b - a)), valid.eq(self.valid)]
        m.d.comb += [hold.en.eq(valid), hold.i.eq(difference)]
        m.d.comb += [self.o[name].eq(hold.o) for name, _ in self.o.shape()]
        return m


CRITERIA.register("spot", SpotCriteria)
