"""How unlike two descriptors are: one pixel of one candidate."""

from amaranth.hdl import Const, Module, Mux, Shape, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.popcount import popcount

GROUP = 6
"""Bits that are compared and counted before the first register."""


class Hamming(wiring.Component):
    """Bits in which two censuses differ; ``neutral`` without a partner, 0 outside the frame. One a clock.

    Members
    -------
    a, b : the censuses.
    absent, inside : one clock after them: there is no partner; the row and column lie in the frame.
    o : the distance, `latency` clocks after the censuses.
    """

    latency = 2

    def __init__(self, bits: int, neutral: int) -> None:
        self._bits, self._neutral = bits, neutral
        self.maximum = bits
        super().__init__(
            {"a": In(bits), "b": In(bits), "absent": In(1), "inside": In(1), "o": Out(range(bits + 1))}
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        unlike = Signal(self._bits)
        m.d.comb += unlike.eq(self.a ^ self.b)
        counts: list[Signal] = []
        for low in range(0, self._bits, GROUP):
            count = popcount(m, unlike[low : low + GROUP])
            counts.append(Signal(len(count), name=f"count_{low}", reset_less=True))
            m.d.sync += counts[-1].eq(count)
        level: list[Value] = list(counts)
        while len(level) > 1:
            level = [sum(level[k : k + 2][1:], level[k]) for k in range(0, len(level), 2)]
        held = Signal(range(self._bits + 1), reset_less=True)
        m.d.sync += held.eq(Mux(self.inside, Mux(self.absent, self._neutral, level[0]), 0))
        m.d.comb += self.o.eq(held)
        return m


class GradientDifference(wiring.Component):
    """``min(|a - b|, truncation)``; ``neutral`` without a partner, 0 outside the frame. One a clock.

    Parameters
    ----------
    limit : a signal that stands for ``truncation``; it may change and is never greater.

    Members
    -------
    a, b : gradients of this shape.
    absent, inside, o : as in `Hamming`.
    """

    latency = 2

    def __init__(
        self, shape: Shape, largest: int, truncation: int, neutral: int, *, limit: Value | None = None
    ) -> None:
        self._neutral, self._largest = neutral, largest
        self.maximum = max(min(truncation, largest), neutral)
        self._truncation = truncation if limit is None else limit
        super().__init__(
            {
                "a": In(shape),
                "b": In(shape),
                "absent": In(1),
                "inside": In(1),
                "o": Out(range(self.maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        difference = Signal((self.a - self.b).shape(), reset_less=True)
        m.d.sync += difference.eq(self.a - self.b)
        bits, top = difference[:-1], difference[-1]
        # The complement of a negative number is its magnitude less 1.
        folded = bits ^ top.replicate(len(bits))
        magnitude = folded + top
        cut: Value = magnitude
        if not isinstance(self._truncation, int) or self._truncation < self._largest:
            cut = Mux(magnitude >= self._truncation, self._truncation, magnitude)
        held = Signal(range(self.maximum + 1), reset_less=True)
        m.d.sync += held.eq(Mux(self.inside, Mux(self.absent, self._neutral, cut), 0))
        m.d.comb += self.o.eq(held)
        return m


class ColourDifference(wiring.Component):
    """The sum of absolute differences over a pixel's channels; 0 outside the frame or without a partner.

    One a clock.

    Parameters
    ----------
    channels, bits : of a pixel.

    Members
    -------
    a, b : pixels.
    absent, inside, o : as in `Hamming`.
    """

    latency = 2

    def __init__(self, channels: int, bits: int) -> None:
        self._channels, self._bits = channels, bits
        self.maximum = channels * ((1 << bits) - 1)
        super().__init__(
            {
                "a": In(channels * bits),
                "b": In(channels * bits),
                "absent": In(1),
                "inside": In(1),
                "o": Out(range(self.maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        total: Value = Const(0, 1)
        for k in range(self._channels):
            a, b = (view[k * self._bits : (k + 1) * self._bits] for view in (self.a, self.b))
            difference = Signal((a - b).shape(), name=f"difference_{k}", reset_less=True)
            m.d.sync += difference.eq(a - b)
            # As in `GradientDifference`: the 1 is the adder's carry.
            folded = difference[:-1] ^ difference[-1].replicate(self._bits)
            total = folded + difference[-1] if k == 0 else total + folded + difference[-1]
        held = Signal(range(self.maximum + 1), reset_less=True)
        m.d.sync += held.eq(Mux(self.inside & ~self.absent, total, 0))
        m.d.comb += self.o.eq(held)
        return m
