"""What a candidate costs, given its criteria: the fuzzy inference, or the plain SAD."""

from amaranth.hdl import Module, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.fuzzy.cell_inference import CellInference
from softdepth.hdl.costs.fuzzy.cell_mean_inference import CellMeanInference
from softdepth.hdl.costs.fuzzy.compensation import Compensation
from softdepth.hdl.costs.fuzzy.inference import RuleInference
from softdepth.hdl.costs.fuzzy.mean_inference import MeanInference
from softdepth.hdl.costs.fuzzy.operators import CELL_OPERATORS, OPERATORS
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from softdepth.spec.operators import REGISTRY


def fraction_layout(config: Config) -> data.StructLayout:
    """A candidate's cost ``num / den``; a plain number has no ``den``, which then counts as 1."""
    (low, high), (_, den_high) = config.cost_range
    den = range(den_high + 1) if config.cost == "fuzzy" else unsigned(0)
    return data.StructLayout({"num": range(low, high + 1), "den": den})


def _ports(config: Config) -> dict[str, wiring.Member]:
    criteria = criteria_layout(config.maxima)
    return {"near": In(1), "i": In(criteria), "o": Out(fraction_layout(config))}


class FuzzyCost(wiring.Component):
    """Fuzzy inference over three criteria, one candidate a clock (Bobyr et al. 2021, steps 2 to 4).

    Members
    -------
    near : the candidate's disparity lies within the compensating rule's bound.
    i : its criteria.
    o : its cost, ``latency`` clocks later; 0 is the best match.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._compensation = Compensation(config)
        self._inference = inference_of(config)(config, self._compensation.maxima)
        self.latency = self._compensation.latency + self._inference.latency
        super().__init__(_ports(config))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.compensation = self._compensation
        m.submodules.inference = self._inference
        m.d.comb += [
            self._compensation.near.eq(self.near),
            self._compensation.i.eq(self.i),
            self._inference.i.eq(self._compensation.o),
            self.o.num.eq(self._inference.num),
            self.o.den.eq(self._inference.den),
        ]
        return m


def inference_of(
    config: Config,
) -> type[CellInference] | type[CellMeanInference] | type[MeanInference] | type[RuleInference]:
    """The smallest component that computes the configured inference."""
    match config.operator, config.rules, config.by_cell:
        case "mean", "printed", False:
            return MeanInference
        case "mean", "corrected", True:
            return CellMeanInference
        case name, _, True if name in CELL_OPERATORS:
            return CellInference
        case name, _, by_cell if name in OPERATORS and (not by_cell or REGISTRY[name].zeroing):
            return RuleInference
        case name, _, _:
            raise ConfigError(
                f"there is no gateware of operator '{name}' with firing = '{config.firing}'",
                f"use one of {CELL_OPERATORS.choices() if config.by_cell else OPERATORS.choices()}",
            )


class SadCost(wiring.Component):
    """The first criterion itself as the cost (eq. 8): the baseline. Wires only.

    Members are those of `FuzzyCost`.
    """

    latency = 0

    def __init__(self, config: Config) -> None:
        super().__init__(_ports(config))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.o.num.eq(self.i.s0)
        return m


COSTS = {"fuzzy": FuzzyCost, "sum": SadCost}
"""The component behind each value of `Config.cost`."""
