"""MEAN's inference over the printed rule base, in closed form (Bobyr et al. 2021, steps 2 to 4)."""

from amaranth.hdl import Cat, Const, Module, Mux
from amaranth.lib import wiring

from softdepth.hdl.arithmetic.adders import Field, add_fields, add_with_carry, magnitude
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline, Word, clocks
from softdepth.hdl.arithmetic.wires import choose, flag, inverted, inverted_if, masked, wire
from softdepth.hdl.costs.fuzzy.inference import inference_ports, position
from softdepth.spec.config import Config

OPERATIONS = 9
"""Carry chains in a row from a criterion to the numerator."""


class MeanInference(wiring.Component):
    """What `RuleInference` computes for MEAN and table 1 as printed, in half of the logic.

    Theta is a sum, so numerator and denominator are sums of memberships and of maxima of their pairs.
    Written in the criteria's distances from the label T, most of it cancels. Let w, u, v be criteria
    1, 2 and 3 minus T, limited to -T .. T, in units of T, and z, x, y their magnitudes. Then::

        d = |x - y|, n = min(x, y), m = max(x, y), t = x + y, e = d - n
        s: the sign of the larger of u and v;  same: both have it;  c = not same and e < 0
        k = max(2 n - 1, 0) if same else 0
        j = max(m if same else t, 2 - t)                                   (rules 13, 22 and 31)
        A = t + (n if same else min(e, 0))
        B = -d if same else -e
        a = z if w > 0 else 2 z
        p = max(0, a + (A if s > 0 else B) - 2)                            (the choice within Y7)
        r = max(0, (B if s > 0 else A) - a)                                (and within Y8)

        den = 9 + z + t + 3 (j + (0 if c else e)) + k + p + r
        num = 14 w + s (5 (t if same else d) + 3 (2 d if c else m)) + (k if s > 0 else 2 k) - p - 2 r

    Choices and negations stand right in front of additions: a carry cell of ECP5 has room for them.
    Members are those of `RuleInference`. One candidate a clock.
    """

    latency = clocks(OPERATIONS)

    def __init__(self, config: Config, maxima: list[int]) -> None:
        self._config = config
        super().__init__(inference_ports(config, maxima))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipe = Pipeline(m)
        bits = self._config.membership_bits
        one = self._config.one

        (x, y, z), (x_below, y_below, z_below) = self._distances(pipe)
        complement = wire(pipe, lambda v: ~v, y, minimum=0, maximum=2 * one - 1)
        above, t = add_fields(pipe, [Field(x, complement), Field(x, y)])
        x_larger = flag(pipe, lambda v: v[bits + 1], above)
        x_smaller = flag(pipe, lambda v: ~v, x_larger)
        d = magnitude(pipe, above, x_smaller, bits + 1, one)
        n = choose(pipe, x_larger, y, x)
        larger = choose(pipe, x_larger, x, y)
        same = flag(pipe, lambda a, b: a == b, x_below, y_below)
        minus = choose(pipe, x_larger, x_below, y_below)  # s < 0

        e = pipe.subtract(d, n)
        c = flag(pipe, lambda same, e: ~same & e[-1], same, e)
        folds = flag(pipe, lambda same, n: same & n[bits - 1 :].any(), same, n)
        twice_n = pipe.shifted(n, 1)

        # 2 - t is the complement of t's low bits, and 1; j is 2 - t while h and t fall short of 2.
        # The constant 9 is 1 instead of k's 0, and 8 in a bit above the other terms.
        h = choose(pipe, same, larger, t)
        falls_short = flag(pipe, lambda v: ~v[bits + 1 :].any(), pipe.add(h, t))
        rest = wire(pipe, lambda v: ~v[: bits + 1], t, minimum=0, maximum=2 * one - 1)
        j = choose(pipe, falls_short, rest, h)
        j_e = add_with_carry(pipe, masked(pipe, e, c, keep=0), j, falls_short, 0, 2 * one)
        k_1 = wire(pipe, lambda f, v: Mux(f, v, one), folds, twice_n, minimum=one, maximum=2 * one)
        terms = pipe.within(pipe.add(pipe.add(t, z), k_1), one, 5 * one)
        terms = wire(pipe, lambda v: v | 8 * one, terms, minimum=9 * one, maximum=13 * one)
        terms = pipe.add(pipe.add(j_e, pipe.shifted(j_e, 1)), terms)

        # p, and -r before it is limited.
        a = choose(pipe, z_below, pipe.shifted(z, 1), z)
        bent = choose(pipe, same, n, masked(pipe, e, c))
        big_a = pipe.within(pipe.add(t, bent), 0, 3 * one)
        minus_b = choose(pipe, same, d, e)
        p = add_with_carry(
            pipe,
            wire(pipe, lambda v: v - 2 * one, a, minimum=-2 * one, maximum=0),
            choose(pipe, minus, inverted(pipe, minus_b), big_a),
            minus,
            -3 * one,
            3 * one,
        )
        minus_r = add_with_carry(
            pipe, a, choose(pipe, minus, inverted(pipe, big_a), minus_b), minus, -3 * one, 3 * one
        )
        has_r = flag(pipe, lambda v: v[-1], minus_r)
        p = masked(pipe, p, flag(pipe, lambda v: v[-1], p), keep=0)
        r_less_1 = masked(pipe, inverted(pipe, minus_r), has_r)
        twice_r_less_1 = wire(pipe, Cat, has_r, r_less_1, minimum=0, maximum=6 * one)
        den = pipe.add(terms, add_with_carry(pipe, p, r_less_1, has_r, 0, 6 * one))
        p_2r = add_with_carry(pipe, p, twice_r_less_1, has_r, 0, 9 * one)

        g = choose(pipe, same, t, d)
        third = choose(pipe, c, pipe.shifted(d, 1), larger)
        sides = pipe.add(pipe.add(g, pipe.shifted(g, 2)), pipe.add(third, pipe.shifted(third, 1)))
        slope = pipe.shifted(pipe.subtract(pipe.shifted(z, 3), z), 1)  # 14 z
        num = add_with_carry(
            pipe,
            inverted_if(pipe, z_below, pipe.within(slope, 0, 14 * one)),
            inverted_if(pipe, minus, pipe.within(sides, 0, 13 * one)),
            z_below,
            -27 * one - 1,
            27 * one,
        )
        k = wire(pipe, lambda f, v: Mux(f, v - one, 0), folds, twice_n, minimum=0, maximum=one)
        num = add_with_carry(
            pipe, num, choose(pipe, minus, pipe.shifted(k, 1), k), minus, -27 * one, 28 * one
        )
        num = pipe.within(pipe.subtract(num, p_2r), *self._config.cost_range[0])

        assert num.time == OPERATIONS
        ready = self.latency * LEVELS
        m.d.comb += [self.num.eq(pipe.at(num, ready).value), self.den.eq(pipe.at(den, ready).value)]
        return m

    def _distances(self, pipe: Pipeline) -> tuple[list[Word], list[Word]]:
        """Of criteria 2, 3 and 1: the distance from T, and whether the criterion is below T."""
        bits = self._config.membership_bits
        fields, below = [], []
        for i in (1, 2, 0):
            fraction, above, limited = position(self._config, self.i, i)
            low = ~above & ~limited
            fraction = fraction | limited.replicate(bits)
            fields.append(
                Field(
                    pipe.input(fraction ^ low.replicate(bits), self._config.one - 1),
                    pipe.input(Const(0, bits), 0),
                    pipe.input(low | limited, 1),
                )
            )
            below.append(pipe.input(low, 1))
        return add_fields(pipe, fields), below
