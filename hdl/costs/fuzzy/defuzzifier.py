"""Defuzzification without a divider (Bobyr et al. 2021, step 4, eq. 10)."""

from amaranth.hdl import Module, Mux
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start, tree_operations
from softdepth.hdl.arithmetic.word import Word
from softdepth.spec.config import Config
from softdepth.spec.rules import CONCLUSIONS, weight

SUM_OPERATIONS = max(
    tree_operations(CONCLUSIONS),
    1 + tree_operations(sum(weight(k).bit_count() for k in range(1, CONCLUSIONS + 1) if weight(k) > 0)),
)
"""Operations in a row of the weighted sum."""


class Defuzzifier(wiring.Component):
    """Numerator and denominator of ``D = sum(Y_k M_k) / sum(Y_k)``; the fraction is compared as it is.

    The weights are small constants, so their products are shifts and adds. If the
    denominator is not above zero, which only strengths below zero can cause, the cost is
    infinite: 1 / 0. One set a clock.

    Members
    -------
    i : ``y1 .. y11``.
    num, den : the fraction, `latency` clocks later, within `Config.cost_range`.
    """

    def __init__(self, config: Config) -> None:
        self._strengths = config.strength_range
        (self._num_low, self._num_high), (_, self._den_high) = config.cost_range
        self._may_vanish = self._strengths[0] < 0
        self._operations = SUM_OPERATIONS + self._may_vanish
        self._start = start(self._operations)
        self.latency = clocks(self._operations)
        conclusion = range(self._strengths[0], self._strengths[1] + 1)
        super().__init__(
            {
                "i": In(data.StructLayout({f"y{k}": conclusion for k in range(1, CONCLUSIONS + 1)})),
                "num": Out(range(self._num_low, self._num_high + 1)),
                "den": Out(range(self._den_high + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        low, high = self._strengths
        conclusions = {
            k: pipeline.input(self.i[f"y{k}"], high, f"y{k}", minimum=low, time=self._start)
            for k in range(1, CONCLUSIONS + 1)
        }
        # Opposite weights share a multiple: 5 (Y_1 - Y_11), 4 (Y_2 - Y_10), ...
        differences = {
            weight(k): y - conclusions[CONCLUSIONS + 1 - k] for k, y in conclusions.items() if weight(k) > 0
        }
        terms: list[Word] = [
            difference << bit
            for factor, difference in differences.items()
            for bit in range(factor.bit_length())
            if factor >> bit & 1
        ]
        ready = self._start + SUM_OPERATIONS
        num = pipeline.sum(sorted(terms, key=lambda t: t.maximum)).at(ready)
        den = pipeline.sum(list(conclusions.values())).at(ready)
        if self._may_vanish:
            vanishes = den.value <= 0
            num = pipeline.result(Mux(vanishes, 1, num.value), num.minimum, num.maximum, ready, "num")
            den = pipeline.result(Mux(vanishes, 0, den.value), 0, den.maximum, ready, "den")
        m.d.comb += [self.num.eq(num.value), self.den.eq(den.value)]
        return m
