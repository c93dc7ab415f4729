"""Defuzzification without a divider (Bobyr et al. 2021, step 4, eq. 10)."""

from amaranth.hdl import Module
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.pipeline import Pipeline, Word, tree_latency
from softdepth.rules import CONCLUSIONS, weight


class Defuzzifier(wiring.Component):
    """Numerator and denominator of ``D = sum(Y_k M_k) / sum(Y_k)``; the fraction is compared as it is.

    The weights are small constants, so that their products are shifts and adds. One set a clock.

    Parameters
    ----------
    maximum : largest conclusion.

    Members
    -------
    i : ``y1 .. y11``.
    num, den : the fraction, `latency` clocks later.
    """

    latency = tree_latency(sum(weight(k).bit_count() for k in range(1, CONCLUSIONS + 1)))

    def __init__(self, maximum: int) -> None:
        self._maximum = maximum
        self.num_maximum = maximum * sum(weight(k) for k in range(1, CONCLUSIONS + 1))
        self.den_maximum = maximum * CONCLUSIONS
        conclusion = range(maximum + 1)
        super().__init__(
            {
                "i": In(data.StructLayout({f"y{k}": conclusion for k in range(1, CONCLUSIONS + 1)})),
                "num": Out(range(self.num_maximum + 1)),
                "den": Out(range(self.den_maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        conclusions = {k: pipeline.input(self.i[f"y{k}"], self._maximum) for k in range(1, CONCLUSIONS + 1)}
        terms: list[Word] = [
            pipeline.shifted(y, bit)
            for k, y in conclusions.items()
            for bit in range(weight(k).bit_length())
            if weight(k) >> bit & 1
        ]
        num = pipeline.at(pipeline.sum(sorted(terms, key=lambda t: t.maximum)), self.latency)
        den = pipeline.at(pipeline.sum(list(conclusions.values())), self.latency)
        m.d.comb += [self.num.eq(num.value), self.den.eq(den.value)]
        return m
