"""MEAN's inference over the corrected rules of one cell, in closed form (Bobyr et al. 2021, steps 2 to 4)."""

from amaranth.hdl import Array, Cat, Const, Module, Value
from amaranth.lib import wiring

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.inference import inference_ports
from softdepth.hdl.pipeline import Pipeline, Word, clocks, start
from softdepth.hdl.wires import choose, flag, wire

OPERATIONS = 4
"""Carry chains in a row from a criterion to the numerator."""


class CellMeanInference(wiring.Component):
    latency = clocks(OPERATIONS)

    def __init__(self, config: Config, maxima: list[int]) -> None:
        self._config = config
        self._maxima = maxima
        super().__init__(inference_ports(config, maxima))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipe = Pipeline(m)
        bits = self._config.membership_bits
        one = self._config.one

        (fraction, raw, top), (b, b_upper), (c, c_upper) = (
            self._fraction(pipe, 0),
            self._position(pipe, 1),
            self._position(pipe, 2),
        )
        upper = flag(pipe, lambda u, t: u | t, raw, top)
        region = wire(pipe, Cat, b_upper, c_upper, raw, top, minimum=0, maximum=15)

        def base(plus):
            table = Array(
                Const((4 if i & 8 else 3 if i & 4 else 0) + (i & 1) + (i >> 1 & 1) + plus, 3)
                for i in range(16)
            )
            return wire(
                pipe, lambda f, r: Cat(f, table[r]), fraction, region, minimum=0, maximum=7 * one
            )

        difference = pipe.subtract(b, c)
        below = flag(pipe, lambda d: d[-1], difference)
        x = choose(pipe, flag(pipe, lambda s, u: s ^ u, below, upper), b, c)
        g = pipe.within(pipe.add(base(0), x), 0, 7 * one)
        den = pipe.result(
            Cat(
                difference.value[0],
                (
                    Cat(below.value, difference.value[1 : bits + 1] ^ below.value.replicate(bits))
                    + Cat(~difference.value[0], Const(one >> 2, bits))
                )[1 : bits + 1],
            ),
            0,
            3 * one // 2,
            difference.time,
        )
        thrice = flag(pipe, lambda a, u, v: (u == v) & (a != u), upper, b_upper, c_upper)
        slope = pipe.within(
            pipe.add(
                difference,
                wire(
                    pipe,
                    lambda d, t: ((d << 1).as_unsigned() & t.replicate(bits + 3)).as_signed(),
                    difference,
                    thrice,
                    minimum=-2 * one,
                    maximum=2 * one,
                ),
            ),
            -3 * one,
            3 * one,
        )
        negate = flag(
            pipe, lambda a, u, v, s: s ^ ~((~a & (u | v)) | (u & v)), upper, b_upper, c_upper, below
        )
        t = add_with_carry(
            pipe,
            base(1),
            wire(
                pipe,
                lambda v, n: (v.as_unsigned() ^ n.replicate(len(v))).as_signed(),
                slope,
                negate,
                minimum=-3 * one - 1,
                maximum=3 * one,
            ),
            negate,
            0,
            8 * one,
        )
        g, t = pipe.aligned(g, t)
        total = g.value + Cat(t.value[3:], Const(0b110, 3))
        num = pipe.result(
            Cat(t.value[:3], total[: bits + 4]).as_signed(), -32 * one, 32 * one, t.time
        )
        ready = start(OPERATIONS) + OPERATIONS
        assert num.time == ready
        den = pipe.at(den, ready)
        m.d.comb += [self.num.eq(num.value), self.den.eq(Cat(Const(0, 1), den.value) | 8 * one)]
        return m

    def _fraction(self, pipe: Pipeline, i: int) -> tuple[Word, Word, Word]:
        bits = self._config.membership_bits
        label_bits = self._config.criteria[i].label_bits
        value = self.i[f"s{i}"]
        value = Cat(value, Const(0, max(0, label_bits + 1 - len(value))))
        top = value[label_bits + 1 :].any()
        f = value[label_bits - bits : label_bits]
        if self._maxima[i] >> (label_bits - bits) > 2 * self._config.one:
            f = f & ~top.replicate(bits)
        time = start(OPERATIONS)
        return (
            pipe.input(f, self._config.one - 1, time=time),
            pipe.input(value[label_bits], 1, time=time),
            pipe.input(top, 1, time=time),
        )

    def _position(self, pipe: Pipeline, i: int) -> tuple[Word, Word]:
        f, upper, top = self._fraction(pipe, i)
        return wire(pipe, Cat, f, top, minimum=0, maximum=self._config.one), flag(
            pipe, lambda u, t: u | t, upper, top
        )
