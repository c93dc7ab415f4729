"""What a candidate costs, given its criteria: the fuzzy inference, or the plain SAD."""

from amaranth.hdl import Module, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import Config
from softdepth.hdl.compensation import Compensation
from softdepth.hdl.defuzzifier import Defuzzifier
from softdepth.hdl.membership import Membership
from softdepth.hdl.rule_array import RuleArray


def criteria_layout(config: Config) -> data.StructLayout:
    """The values of all criteria of one candidate, ``s0`` onwards."""
    return data.StructLayout({f"s{i}": range(c.maximum + 1) for i, c in enumerate(config.criteria)})


def fraction_layout(config: Config) -> data.StructLayout:
    """A candidate's cost ``num / den``; a plain number has no ``den``, which then is 1."""
    (low, high), (_, den_high) = config.cost_range
    den = range(den_high + 1) if config.cost == "fuzzy" else unsigned(0)
    return data.StructLayout({"num": range(low, high + 1), "den": den})


def _ports(config: Config) -> dict[str, wiring.Member]:
    return {"near": In(1), "i": In(criteria_layout(config)), "o": Out(fraction_layout(config))}


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
        self._memberships = [
            Membership(config, criterion.label_bits, maximum)
            for criterion, maximum in zip(config.criteria, self._compensation.maxima, strict=True)
        ]
        self._rules = RuleArray(config)
        self._defuzzifier = Defuzzifier(config)
        self.latency = (
            self._compensation.latency + Membership.latency + self._rules.latency + self._defuzzifier.latency
        )
        super().__init__(_ports(config))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.compensation = self._compensation
        m.submodules.rules = self._rules
        m.submodules.defuzzifier = self._defuzzifier
        m.d.comb += [
            self._compensation.near.eq(self.near),
            self._compensation.i.eq(self.i),
            self._defuzzifier.i.eq(self._rules.o),
            self.o.num.eq(self._defuzzifier.num),
            self.o.den.eq(self._defuzzifier.den),
        ]
        for i, membership in enumerate(self._memberships):
            m.submodules[f"membership_{i}"] = membership
            m.d.comb += [
                membership.i.eq(self._compensation.o[f"s{i}"]),
                self._rules.i[i].eq(membership.o),
            ]
        return m


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


COSTS = {"fuzzy": FuzzyCost, "sad": SadCost}
"""The component behind each value of `Config.cost`."""
