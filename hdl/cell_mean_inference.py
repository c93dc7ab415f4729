"""MEAN's inference over the corrected rules of a cell, in closed form (Bobyr et al. 2021, steps 2 to 4)."""

from amaranth.hdl import Array, Cat, Const, Module, Mux, Value
from amaranth.lib import wiring

from softdepth.config import Config
from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.inference import inference_ports
from softdepth.hdl.pipeline import Pipeline, Word, clocks, start
from softdepth.hdl.wires import choose, flag, wire

OPERATIONS = 5
"""The limit of the criteria, and four carry chains in a row from there to the numerator."""


class CellMeanInference(wiring.Component):
    """What `RuleInference` computes for MEAN, ``rules="corrected"`` and ``firing="cell"``, in five sums.

    Theta is a sum, and the six firing strengths of a cell belong to six conclusions in a row, so that all
    maxima are one distance. Let A, B and C be the membership of criteria 1, 2 and 3 in the upper one of
    the two labels that they lie between, and the bits a, b and c tell that this label is high, not middle.
    In units of `Config.one`, with ``p = 3 a + b + c``::

        den = 9 + 2 |B - C|
        num = 9 A + 4 (B + C) + (2 p - 5) |B - C| + 9 p - 31
            = 8 (A + p + X) + (A + p + 1 + Z) - 32

        X = max(B, C) if a else min(B, C);  Y: the other one
        Z = X - Y if a = b = c else Y - X;  thrice that where b = c, but not a

    Z is never less than ``-(A + p + 1)``, so that the bits above its sum are free for the 32. It is
    ``B - C`` or the opposite, and that and the choice of X stand right in front of additions: a carry cell
    of ECP5 has room for them. Where a criterion is limited to 2T, a reset clears its bits below 2T.

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
        a, b, c, upper, alike, thrice = self._positions(pipe)

        # B - C, and in place of its sign whether X is B: upper's bit turns it over.
        chain = (Cat(b.value, upper.value) - c.value)[: bits + 2]
        turned = pipe.result(chain, 0, 4 * one - 1, b.time)
        x_is_b = flag(pipe, lambda v: v[-1], turned)
        below = flag(pipe, lambda x, u: x ^ u, x_is_b, upper)
        distance = wire(
            pipe, lambda v, s: Cat(v[:-1], s).as_signed(), turned, below, minimum=-one, maximum=one
        )
        first, half, z = self._three_sums(pipe, a, choose(pipe, x_is_b, b, c), distance, thrice)

        minus = pipe.at(flag(pipe, lambda x, same: x ^ same, x_is_b, alike), z.time)
        z = wire(
            pipe,
            lambda v, n: (v ^ n.replicate(len(v))).as_signed(),
            z,
            minus,
            minimum=-3 * one - 1,
            maximum=3 * one,
        )
        a_1 = wire(pipe, self._plus_one, pipe.at(a, z.time), minimum=one, maximum=7 * one)
        second = add_with_carry(pipe, a_1, z, minus, 0, 8 * one)
        first, second = pipe.aligned(first, second)
        high = first.value + Cat(second.value[3:], Const(0b110, 3))
        num = Cat(second.value[:3], high[: bits + 4]).as_signed()
        num = pipe.result(num, *self._config.cost_range[0], second.time)

        ready = start(OPERATIONS) + OPERATIONS
        assert num.time == ready
        den = Cat(Const(0, 1), pipe.at(half, ready).value) | 8 * one
        m.d.comb += [self.num.eq(num.value), self.den.eq(den)]
        return m

    def _positions(self, pipe: Pipeline) -> tuple[Word, Word, Word, Word, Word, Word]:
        """``A + p``, B, C; then the bit a, whether b and c equal it, and whether both do not."""
        one = self._config.one
        (a, upper, a_top), (b, b_upper, b_top), (c, c_upper, c_top) = map(self._limited, range(3))
        # A's carry counts in p: 1.0 has no bit of its own.
        counts = [3 * (i >> 2 & 1) + (i >> 3) + (i >> 1 & 1) + (i & 1) for i in range(16)]
        p = Array(Const(count, 3) for count in counts)[Cat(b_upper, c_upper, upper, a_top)]
        alike = (upper == b_upper) & (upper == c_upper)
        thrice = (upper != b_upper) & (upper != c_upper)
        maxima = (6 * one, one, one, 1, 1, 1)
        values = ((a, p), (b, b_top), (c, c_top), (upper,), (alike,), (thrice,))

        def registered(part: Value, maximum: int) -> Value:
            return pipe.result(part, 0, maximum, start(OPERATIONS)).value

        time = start(OPERATIONS) + 1
        words = (
            Word(Cat(*(registered(part, (1 << len(part)) - 1) for part in parts)), 0, maximum, time)
            for parts, maximum in zip(values, maxima, strict=True)
        )
        return tuple(words)  # pyright: ignore

    def _limited(self, i: int) -> tuple[Value, Value, Value]:
        """Of a criterion: its bits below T, whether it reaches T, and whether it reaches 2T."""
        bits = self._config.membership_bits
        label_bits = self._config.criteria[i].label_bits
        value = self.i[f"s{i}"]
        value = Cat(value, Const(0, max(0, label_bits + 1 - len(value))))  # it may never reach T
        top = value[label_bits + 1 :].any()
        return Mux(top, 0, value[label_bits - bits : label_bits]), value[label_bits] | top, top

    def _three_sums(
        self, pipe: Pipeline, a: Word, x: Word, distance: Word, thrice: Word
    ) -> tuple[Word, Word, Word]:
        """``A + p + X``, ``den / 2 - 4`` and ``B - C`` or its triple, in one carry chain.

        The first two have no carry out. The others lack their lowest bit there, which is that of
        ``B - C``; where a magnitude is a complement and 1, what that bit carries is the lowest sum.
        """
        bits = self._config.membership_bits
        one = self._config.one
        a, x, distance, thrice = pipe.aligned(a, x, distance, thrice)
        d = distance.value
        below = d[-1]
        magnitude = Cat(below, d[1:-1] ^ below.replicate(bits))
        total = Cat(a.value, magnitude, d[1:], below) + Cat(
            x.value, Const(0, 2), ~d[0], Const(one >> 2, bits), d & thrice.value.replicate(bits + 2)
        )
        width = 3 * bits + 6
        sums = pipe.result(Cat(d[0], total[:width]), 0, (2 << width) - 1, distance.time)
        lowest, rest = sums.value[0], sums.value[1:]
        return (
            Word(rest[: bits + 3], 0, 7 * one, sums.time),
            Word(Cat(lowest, rest[bits + 4 : 2 * bits + 4]), one >> 1, 3 * one >> 1, sums.time),
            Word(Cat(lowest, rest[2 * bits + 4 :]), -3 * one, 3 * one, sums.time),
        )

    def _plus_one(self, word: Value) -> Value:
        """``A + p`` and 1, in tables."""
        bits = self._config.membership_bits
        p = word[bits:]
        return Cat(word[:bits], ~p[0], p[1] ^ p[0], p[2] ^ (p[1] & p[0]))
