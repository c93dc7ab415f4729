"""Fuzzy inference over the rules of a cell: from the criteria of a candidate to its cost as a fraction."""

from amaranth.hdl import Cat, Const, Module, Mux, Value
from amaranth.lib import wiring

from softdepth.hdl.arithmetic.adders import Field, add_fields, add_with_carry
from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start
from softdepth.hdl.arithmetic.wires import choose
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.cell_rules import joins_corners
from softdepth.hdl.costs.fuzzy.inference import inference_ports, position
from softdepth.hdl.costs.fuzzy.operators import CELL_OPERATORS
from softdepth.hdl.costs.fuzzy.operators.cell import Position
from softdepth.spec.config import Config

SUM_OPERATIONS = 5
"""Operations in a row from the firing strengths to the numerator."""


class CellInference(wiring.Component):
    """Any operator over the eight rules whose labels are next to the criteria (Bobyr et al. 2021, step 3).

    A criterion lies between two labels, T and one on either side of it, and their memberships sum to 1.
    Let b and c be those of criteria 2 and 3 in their upper label, and z that of criterion 1 in its
    outer one. The eight rules are three conclusions for each of criterion 1's labels::

        P_0 = Theta(1 - b, 1 - c)
        P_1 = max(Theta(b, 1 - c), Theta(1 - b, c))
        P_2 = Theta(b, c)
        F_j = Theta(z, P_j), G_j = Theta(1 - z, P_j)

    The weight of ``G_j`` is ``e + j - 1``, with e the number of criteria 2 and 3 above T, less 1; that of
    ``F_j`` is 3 more where criterion 1 is above T, and 3 less below::

        den = sum of F + sum of G
        num = F_2 - F_0 + G_2 - G_0 + e den +- 3 sum of F

    The printed table joins corners of some cells to ``P_1`` (`joins_corners`): then the larger of both
    fires in ``F_1`` or ``G_1``, and the corner does not.

    Members are those of `RuleInference`. One candidate a clock.
    """

    def __init__(self, config: Config, maxima: list[int]) -> None:
        self._config = config
        self._joins = joins_corners(config.rules)
        self._operator = CELL_OPERATORS[config.operator](config)
        self._operations = (
            1 + self._operator.corner_operations + self._operator.fire_operations + SUM_OPERATIONS
        )
        self._start = start(self._operations)
        self.latency = clocks(self._operations)
        super().__init__(inference_ports(config, maxima))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipe = Pipeline(m)
        a, a_above = self._position(pipe)
        (b, b_above), (c, c_above) = (self._upper(pipe, i) for i in (1, 2))

        ready = self._start + 1 + self._operator.corner_operations
        pairs = [pair.at(ready) for pair in self._operator.corners(pipe, b, c)]
        a = Position(a.outer.at(ready), a.middle.at(ready))
        (f0, f1, f2), (g0, g1, g2) = zip(*(self._operator.fire(pipe, a, pair) for pair in pairs), strict=True)
        both = b_above & c_above
        neither = ~b_above & ~c_above
        if self._joins:
            # Which pair is larger is found once, then which strengths count.
            larger = choose(b_above.at(ready), pairs[2], pairs[0]) > pairs[1]
            in_f = a_above & neither
            f1 = choose(in_f & larger, f0, f1)
            f0 = choose(in_f, 0, f0)
            g1 = choose(both & larger, g2, g1)
            g2 = choose(both, 0, g2)

        low, high = self._config.strength_range
        f = f0 + f1 + f2
        g = g1 + g2
        # A carry of 0: without it, synthesis makes one sum of three operands, which takes more logic.
        den = f + add_with_carry(g, g0, 0, 3 * low, 3 * high)
        # What the complements lack: 1 in f2 - f0, and nothing in g2 - g0, which is itself a complement.
        f_rise = f2 + f0.inverted
        g_fall = g0 + g2.inverted
        num = add_with_carry(f_rise, g_fall.inverted, 1, -6 * high, 6 * high)
        e_den = choose(both, den, choose(neither, den.inverted, 0))
        num = add_with_carry(num, e_den, neither, -6 * high, 6 * high)
        f_3 = (f + (f << 1)).at(num.time)
        f_3 = choose(a_above, f_3, f_3.inverted)
        num = add_with_carry(num, f_3, ~a_above, *self._config.cost_range[0])
        den = den.at(num.time).within(*self._config.cost_range[1])
        assert num.time == self._start + self._operations
        m.d.comb += [self.num.eq(num.value), self.den.eq(den.value)]
        return m

    def _upper(self, pipe: Pipeline, i: int) -> tuple[Word, Word]:
        """A criterion's membership in the upper of its two labels, and whether it is above T."""
        fraction, above, limited = position(self._config, self.i, i)
        upper = Cat(Mux(limited, 0, fraction), limited)
        return (
            pipe.result(upper, 0, self._config.one, self._start, f"upper_{i}"),
            pipe.result(above | limited, 0, 1, self._start, f"above_{i}"),
        )

    def _position(self, pipe: Pipeline) -> tuple[Position, Word]:
        """Criterion 1's memberships in its outer label and the middle one, and whether it is above T."""
        fraction, above, limited = position(self._config, self.i, 0)
        above = above | limited
        fraction = fraction | limited.replicate(len(fraction))
        none = pipe.input(Const(0, len(fraction)), 0, "none", time=self._start)

        def membership(bits: Value, carry: Value) -> Word:
            word = pipe.input(bits, self._config.one - 1, "fraction", time=self._start)
            return add_fields([Field(word, none, pipe.input(carry, 1, "carry", time=self._start))])[0]

        inverse = above.replicate(len(fraction))
        outer = membership(fraction ^ ~inverse, ~above | limited)
        middle = membership(fraction ^ inverse, above & ~limited)
        return Position(outer, middle), pipe.result(above, 0, 1, self._start, "above_0")
