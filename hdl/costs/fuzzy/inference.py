"""Fuzzy inference: from the criteria of a candidate to its cost as a fraction."""

from amaranth.hdl import Cat, Const, Module, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.fuzzy.defuzzifier import Defuzzifier
from softdepth.hdl.costs.fuzzy.membership import Membership
from softdepth.hdl.costs.fuzzy.rule_array import RuleArray
from softdepth.spec.config import Config


def inference_ports(config: Config, maxima: list[int]) -> dict[str, wiring.Member]:
    """Criteria up to ``maxima`` in, a fraction within `Config.cost_range` out."""
    (num_low, num_high), (_, den_high) = config.cost_range
    return {
        "i": In(criteria_layout(maxima)),
        "num": Out(range(num_low, num_high + 1)),
        "den": Out(range(den_high + 1)),
    }


def position(config: Config, criteria: data.View, i: int) -> tuple[Value, Value, Value]:
    """Where a criterion lies: how far above the lower of two labels, in units of ``1 / one``; whether that is
    T; and whether it reaches 2T, where the other two mean nothing."""
    label_bits = config.criteria[i].label_bits
    value = Value.cast(criteria[f"s{i}"])
    value = Cat(value, Const(0, max(0, label_bits + 1 - len(value))))  # it may never reach T
    fraction = value[label_bits - config.membership_bits : label_bits]
    return fraction, value[label_bits], value[label_bits + 1 :].any()


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
