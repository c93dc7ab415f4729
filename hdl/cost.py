"""What a candidate costs, given its criteria: the fuzzy inference, or the plain SAD."""

from amaranth.hdl import Module, ShapeLike
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


def _ports(config: Config, num_maximum: int, den_maximum: int) -> dict[str, wiring.Member]:
    num: ShapeLike = range(num_maximum + 1)
    den: ShapeLike = range(den_maximum + 1)
    return {"near": In(1), "i": In(criteria_layout(config)), "num": Out(num), "den": Out(den)}


class FuzzyCost(wiring.Component):
    """Fuzzy inference over three criteria, one candidate a clock (Bobyr et al. 2021, steps 2 to 4).

    Members
    -------
    near : the candidate's disparity lies within the compensating rule's bound.
    i : its criteria.
    num, den : its cost ``num / den``, ``latency`` clocks later; 0 is the best match.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._compensation = Compensation(config)
        self._memberships = [
            Membership(config, criterion.label_bits, maximum)
            for criterion, maximum in zip(config.criteria, self._compensation.maxima, strict=True)
        ]
        self._rules = RuleArray(config)
        self._defuzzifier = Defuzzifier(self._rules.maximum)
        self.num_maximum = self._defuzzifier.num_maximum
        self.den_maximum = self._defuzzifier.den_maximum
        self.latency = (
            self._compensation.latency + Membership.latency + self._rules.latency + self._defuzzifier.latency
        )
        super().__init__(_ports(config, self.num_maximum, self.den_maximum))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.compensation = self._compensation
        m.submodules.rules = self._rules
        m.submodules.defuzzifier = self._defuzzifier
        m.d.comb += [
            self._compensation.near.eq(self.near),
            self._compensation.i.eq(self.i),
            self._defuzzifier.i.eq(self._rules.o),
            self.num.eq(self._defuzzifier.num),
            self.den.eq(self._defuzzifier.den),
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

    Members are those of `FuzzyCost`; ``den`` has no bits.
    """

    latency = 0
    den_maximum = 0

    def __init__(self, config: Config) -> None:
        self.num_maximum = config.criteria[0].maximum
        super().__init__(_ports(config, self.num_maximum, self.den_maximum))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.num.eq(self.i.s0)
        return m


COSTS = {"fuzzy": FuzzyCost, "sad": SadCost}
"""The component behind each value of `Config.cost`."""
