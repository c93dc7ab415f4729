"""Counting bits and comparing colours, every case."""

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike, coarse, coarse_like
from softdepth.hdl.arithmetic.popcount import popcount
from tests.support.simulation import observe


class Count(wiring.Component):
    def __init__(self, bits: int) -> None:
        super().__init__({"i": In(bits), "o": Out(range(bits + 1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.o.eq(popcount(m, self.i))
        return m


class Alike(wiring.Component):
    def __init__(self, like: int) -> None:
        self._like = like
        super().__init__({"a": In(10), "b": In(10), "o": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.o.eq(alike(self.a, self.b, 2, self._like))
        return m


class AlikeInPart(wiring.Component):
    """Whether two colours of two channels are alike by their upper ``kept`` bits."""

    def __init__(self, kept: int) -> None:
        self._kept = kept
        super().__init__({"a": In(8), "b": In(8), "like": In(5), "o": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        a, b = (coarse(colour, 2, self._kept) for colour in (self.a, self.b))
        m.d.comb += self.o.eq(alike(a, b, 2, coarse_like(self.like, 4 - self._kept)))
        return m


@pytest.mark.parametrize("kept", [1, 2, 3, 4])
def test_colours_of_fewer_bits_are_alike(kept: int) -> None:
    """A threshold that is a signal means what a number means, and what the upper bits are worth."""
    unit = 1 << 4 - kept
    likes = (0, 1, 3, 5, 8, 16)
    cases = [(a, b, like) for a in range(0, 256, 7) for b in range(0, 256, 11) for like in likes]
    found = observe(AlikeInPart(kept), [{"a": a, "b": b, "like": like} for a, b, like in cases], "o")
    for (a, b, like), got in zip(cases, found, strict=True):
        channels = [(a % 16, b % 16), (a // 16, b // 16)]
        assert got == all(unit * abs(p // unit - q // unit) < like for p, q in channels), (a, b, like)
        assert coarse_like(like, 4 - kept) == -(-like // unit)


@pytest.mark.parametrize("bits", [1, 2, 6, 9])
def test_popcount(bits: int) -> None:
    found = observe(Count(bits), [{"i": word} for word in range(2**bits)], "o")
    assert found == [word.bit_count() for word in range(2**bits)]


@pytest.mark.parametrize("like", [1, 2, 5, 8, 16, 20, 32, 256])
def test_alike(like: int) -> None:
    """Two channels of five bits: one goes through all pairs, the other departs now and then."""
    cases = [(a, b, other) for a in range(32) for b in range(32) for other in ((0, 0), (31, 32 - like))]
    cases = [(a, b, (p, max(q, 0) % 32)) for a, b, (p, q) in cases]
    clocks = [{"a": a | p << 5, "b": b | q << 5} for a, b, (p, q) in cases]
    expected = [int(abs(a - b) < like and abs(p - q) < like) for a, b, (p, q) in cases]
    assert observe(Alike(like), clocks, "o") == expected
