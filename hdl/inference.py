"""Fuzzy inference: from the criteria of a candidate to its cost as a fraction."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import Config
from softdepth.hdl.criteria import criteria_layout
from softdepth.hdl.defuzzifier import Defuzzifier
from softdepth.hdl.membership import Membership
from softdepth.hdl.rule_array import RuleArray


def inference_ports(config: Config, maxima: list[int]) -> dict[str, wiring.Member]:
    """Criteria up to ``maxima`` in, a fraction within `Config.cost_range` out."""
    (num_low, num_high), (_, den_high) = config.cost_range
    return {
        "i": In(criteria_layout(maxima)),
        "num": Out(range(num_low, num_high + 1)),
        "den": Out(range(den_high + 1)),
    }


class RuleInference(wiring.Component):
    """Memberships, the rule array and defuzzification: any operator, any rule base.

    Members
    -------
    i : a candidate's criteria, after the compensating rule.
    num, den : its cost, ``latency`` clocks later; the smallest fraction is the best match.

    One candidate a clock.
    """

    def __init__(self, config: Config, maxima: list[int]) -> None:
        self._memberships = [
            Membership(config, criterion.label_bits, maximum)
            for criterion, maximum in zip(config.criteria, maxima, strict=True)
        ]
        self._rules = RuleArray(config)
        self._defuzzifier = Defuzzifier(config)
        self.latency = Membership.latency + self._rules.latency + self._defuzzifier.latency
        super().__init__(inference_ports(config, maxima))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.rules = self._rules
        m.submodules.defuzzifier = self._defuzzifier
        m.d.comb += [
            self._defuzzifier.i.eq(self._rules.o),
            self.num.eq(self._defuzzifier.num),
            self.den.eq(self._defuzzifier.den),
        ]
        for i, membership in enumerate(self._memberships):
            m.submodules[f"membership_{i}"] = membership
            m.d.comb += [membership.i.eq(self.i[f"s{i}"]), self._rules.i[i].eq(membership.o)]
        return m
