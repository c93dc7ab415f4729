"""MEAN's inference over the printed rule base, in closed form (Bobyr et al. 2021, steps 2 to 4)."""

from amaranth.hdl import Cat, Const, Module, Mux
from amaranth.lib import wiring

from softdepth.hdl.arithmetic.adders import Field, add_fields, add_with_carry, distance
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline, clocks
from softdepth.hdl.arithmetic.wires import choose, flag, inverted_if, wire
from softdepth.hdl.arithmetic.word import Word
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

    Choices and negations come right before additions, because an ECP5 carry cell has room for them.
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
        complement = wire(lambda v: ~v, y, minimum=0, maximum=2 * one - 1)
        above, t = add_fields([Field(x, complement), Field(x, y)])
        t = t.named("t")
        x_larger = above[bits + 1]
        d = distance(above, ~x_larger, bits + 1, one)
        n = choose(x_larger, y, x).named("n")
        larger = choose(x_larger, x, y).named("larger")
        same = (~(x_below ^ y_below)).named("same")
        minus = choose(x_larger, x_below, y_below).named("minus")  # s < 0

        e = d - n
        c = choose(same, 0, e.negative).named("c")
        folds = flag(lambda same, n: same & n[bits - 1 :].any(), same, n).named("folds")
        twice_n = n << 1

        # 2 - t is the complement of t's low bits, and 1; j is 2 - t while h and t fall short of 2.
        # The constant 9 is 1 instead of k's 0, and 8 in a bit above the other terms.
        h = choose(same, larger, t).named("h")
        falls_short = flag(lambda v: ~v[bits + 1 :].any(), h + t)
        rest = wire(lambda v: ~v[: bits + 1], t, minimum=0, maximum=2 * one - 1)
        j = choose(falls_short, rest, h)
        j_e = add_with_carry(choose(c, 0, e), j, falls_short, 0, 2 * one)
        k_1 = wire(lambda f, v: Mux(f, v, one), folds, twice_n, minimum=one, maximum=2 * one)
        terms = (t + z + k_1).within(one, 5 * one)
        terms = wire(lambda v: v | 8 * one, terms, minimum=9 * one, maximum=13 * one)
        terms = j_e + (j_e << 1) + terms

        # p, and -r before it is limited.
        a = choose(z_below, z << 1, z)
        a_less_2 = wire(lambda v: v - 2 * one, a, minimum=-2 * one, maximum=0)
        big_a = (t + choose(same, n, choose(c, e, 0))).within(0, 3 * one)
        minus_b = choose(same, d, e)
        bounds = -3 * one, 3 * one
        p = add_with_carry(a_less_2, choose(minus, minus_b.inverted, big_a), minus, *bounds)
        minus_r = add_with_carry(a, choose(minus, big_a.inverted, minus_b), minus, *bounds)
        has_r = minus_r.negative
        p = choose(p.negative, 0, p)
        r_less_1 = choose(has_r, minus_r.inverted, 0)
        twice_r_less_1 = wire(Cat, has_r, r_less_1, minimum=0, maximum=6 * one)
        den = terms + add_with_carry(p, r_less_1, has_r, 0, 6 * one)
        p_2r = add_with_carry(p, twice_r_less_1, has_r, 0, 9 * one)

        g = choose(same, t, d).named("g")
        third = choose(c, d << 1, larger).named("third")
        sides = (g + (g << 2)) + (third + (third << 1))
        # 14 z, of z one clock later, which is kept anyway: right behind z it would be the longest path.
        z = z.at(t.time)
        slope = ((z << 3) - z) << 1
        num = add_with_carry(
            inverted_if(z_below, slope.within(0, 14 * one)),
            inverted_if(minus, sides.within(0, 13 * one)),
            z_below,
            -27 * one - 1,
            27 * one,
        )
        k = wire(lambda f, v: Mux(f, v - one, 0), folds, twice_n, minimum=0, maximum=one).named("k")
        num = add_with_carry(num, choose(minus, k << 1, k), minus, -27 * one, 28 * one)
        num = (num - p_2r).within(*self._config.cost_range[0])

        assert num.time == OPERATIONS
        ready = self.latency * LEVELS
        m.d.comb += [self.num.eq(num.at(ready).value), self.den.eq(den.at(ready).value)]
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
                    pipe.input(fraction ^ low.replicate(bits), self._config.one - 1, f"fraction_{i}"),
                    pipe.input(Const(0, bits), 0, "none"),
                    pipe.input(low | limited, 1, f"carry_{i}"),
                )
            )
            below.append(pipe.input(low, 1, f"below_{i}"))
        distances = add_fields(fields)
        return [word.named(name) for word, name in zip(distances, "xyz", strict=True)], below
