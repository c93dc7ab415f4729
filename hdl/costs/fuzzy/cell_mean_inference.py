"""MEAN's inference over the corrected rules of a cell, in closed form (Bobyr et al. 2021, steps 2 to 4)."""

from dataclasses import replace

from amaranth.hdl import Cat, Const, Module, Mux, Value
from amaranth.lib import wiring

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start
from softdepth.hdl.arithmetic.wires import choose, wire
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.inference import inference_ports, position
from softdepth.spec.config import Config

OPERATIONS = 5
"""The limit of the criteria, and four carry chains in a row from there to the numerator."""


class CellMeanInference(wiring.Component):
    """What `RuleInference` computes for MEAN, ``rules="corrected"`` and ``firing="cell"``, in six sums.

    Theta is a sum, and the six firing strengths of a cell belong to six conclusions in a row, so all
    maxima are one distance. Let A, B and C be the membership of criteria 1, 2 and 3 in the upper one of
    the two labels that they lie between; the bits a, b and c tell that this label is high, not middle.
    In units of `Config.one`, with ``p = 3 a + b + c``::

        den = 9 + 2 |B - C|
        num = 9 A + 4 (B + C) + (2 p - 5) |B - C| + 9 p - 31
            = 8 (A + p + X) + (A + p + 1 + Z) - 32

        X = max(B, C) if a else min(B, C);  Y: the other one
        Z = X - Y if a = b = c else Y - X;  thrice that where both b and c differ from a

    The second bracket is 0 to 8, so the -32 is constant bits above it. Z is ``B - C`` or its triple,
    or the opposite of that; X is chosen and Z complemented right in front of an addition, where a carry
    cell of ECP5 has room for it. A reset or set of registers limits a criterion to 2T,
    which takes no logic. Two pairs of sums share a carry chain each: one adder for every sum takes 4 LUT4
    more in a lane of `compact` (547 instead of 543), and none in one of `lite`.

    Members are those of `RuleInference`. One candidate a clock.
    """

    latency = clocks(OPERATIONS)

    def __init__(self, config: Config, maxima: list[int]) -> None:
        self._config = config
        super().__init__(inference_ports(config, maxima))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipe = Pipeline(m)
        one = self._config.one
        (a, b, c), (upper, b_differs, c_differs) = self._limited(pipe)

        # B - C, with X is B in place of its sign: the bit a above B inverts it.
        turned = (Cat(b.value, upper.value) - c.value)[: len(b.value) + 1]
        turned = pipe.result(turned, 0, 4 * one - 1, b.time, "turned")
        x_is_b = turned[len(turned) - 1].named("x_is_b")
        below = (x_is_b ^ upper).named("below")
        d = wire(lambda v, s: Cat(v[:-1], s), turned, below, minimum=0, maximum=4 * one - 1).named("d")

        thrice = b_differs & c_differs
        first, z = self._first_and_z(pipe, a, choose(x_is_b, b, c), d, thrice)
        equal = ~(b_differs | c_differs)
        minus = (x_is_b ^ equal).named("minus")
        negative = (upper ^ equal).named("negative")
        half, second = self._half_and_second(pipe, a, d, z, minus, negative)

        first, second = pipe.aligned(first, second)
        high = first.value + Cat(second.value[3:], Const(0b110, 3))
        num = Cat(second.value[:3], high[: len(first.value) + 1]).as_signed()
        num = pipe.result(num, *self._config.cost_range[0], second.time, "num")

        ready = start(OPERATIONS) + OPERATIONS
        assert num.time == ready
        den = Cat(Const(0, 1), half.at(ready).value) | 8 * one
        m.d.comb += [self.num.eq(num.value), self.den.eq(den)]
        return m

    def _limited(self, pipe: Pipeline) -> tuple[list[Word], list[Word]]:
        """``A + p``, B and C; then the bit a, whether b differs from it, and whether c does."""
        bits = self._config.membership_bits
        one = self._config.one
        time = start(OPERATIONS)

        def stored(value: Value, name: str) -> Value:
            return pipe.result(value, 0, (1 << len(value)) - 1, time, name).value

        def word(value: Value, maximum: int, name: str) -> Word:
            return pipe.input(value, maximum, name, time=time + 1)

        (a, a_beyond, a_top), *others = (position(self._config, self.i, i) for i in range(3))
        a_upper = a_beyond | a_top
        (_, b_beyond, b_top), (_, c_beyond, c_top) = others
        b_differs = stored(a_upper ^ (b_beyond | b_top), "b_differs")
        c_differs = stored(a_upper ^ (c_beyond | c_top), "c_differs")
        b, c = (
            Cat(stored(Mux(top, 0, v), f"low_{name}"), stored(top, f"{name}_top"))
            for name, (v, _, top) in zip("bc", others, strict=True)
        )
        a = stored(Mux(a_top, one, Cat(a, a_beyond)), "a")
        upper = a[-1]
        return (
            [
                word(
                    Cat(a[:bits], _count(b_differs, c_differs, upper, stored(a_top, "a_top"))), 6 * one, "a_p"
                ),
                word(b, one, "b"),
                word(c, one, "c"),
            ],
            [word(upper, 1, "upper"), word(b_differs, 1, "b_differs"), word(c_differs, 1, "c_differs")],
        )

    def _first_and_z(self, pipe: Pipeline, a: Word, x: Word, d: Word, thrice: Word) -> tuple[Word, Word]:
        """``A + p + X``, and `d` or its triple without the sign, which is that of `d`: side by side.

        The first has no carry out. The second's lowest bit is that of `d`.
        """
        bits = self._config.membership_bits
        one = self._config.one
        a, x, d, thrice = pipe.aligned(a, x, d, thrice)
        once, again = d.value[1:], d.value[:-1] & thrice.value.replicate(bits + 1)
        total = Cat(a.value, once) + Cat(x.value, Const(0, 2), again)
        total = pipe.result(total[: 2 * bits + 4], 0, (16 << 2 * bits) - 1, d.time, "first_and_z")
        low = d.at(total.time).value[0]
        z = Cat(low, total.value[bits + 3 :])
        return (
            replace(total[: bits + 3], maximum=7 * one),
            pipe.input(z, 4 * one - 1, "z", time=total.time),
        )

    def _half_and_second(
        self, pipe: Pipeline, a: Word, d: Word, z: Word, minus: Word, negative: Word
    ) -> tuple[Word, Word]:
        """``den / 2 - 4``, and ``A + p + 1 + Z``: side by side.

        The first has no carry out. Its lowest bit is that of `d`; what that carries where the magnitude
        is the complement of `d` and 1 is the lowest sum.
        """
        bits = self._config.membership_bits
        one = self._config.one
        a, d, z, minus, negative = pipe.aligned(a, d, z, minus, negative)
        below = minus.value ^ negative.value  # the sign of d
        magnitude = Cat(below, d.value[1:-1] ^ below.replicate(bits))
        p = a.value[bits:]
        next_p = Cat(~p[0], p[1] ^ p[0], p[2] ^ (p[1] & p[0]))  # no adder of its own
        term = Cat(z.value ^ minus.value.replicate(bits + 2), negative.value.replicate(2))
        total = Cat(magnitude, minus.value, a.value[:bits], next_p, Const(0, 1)) + Cat(
            ~d.value[0], Const(one >> 2, bits), minus.value, term
        )
        total = pipe.result(total[: 2 * bits + 6], 0, (64 << 2 * bits) - 1, z.time, "half_and_second")
        half = Cat(d.at(total.time).value[0], total.value[1 : bits + 1])
        return (
            pipe.input(half, 3 * one >> 1, "half", minimum=one >> 1, time=total.time),
            replace(total[bits + 2 :], maximum=8 * one),
        )


def _count(b_differs: Value, c_differs: Value, a: Value, a_top: Value) -> Value:
    """p, and one more where A has reached 1: three tables of four inputs."""
    cell = Cat(b_differs, c_differs, a, a_top)
    counts = [
        3 * upper + (upper ^ v) + (upper ^ w) + top
        for top in (0, 1)
        for upper in (0, 1)
        for w in (0, 1)
        for v in (0, 1)
    ]
    ones = ([i for i, count in enumerate(counts) if count >> bit & 1] for bit in range(3))
    return Cat(Cat(cell == i for i in cells).any() for cells in ones)
