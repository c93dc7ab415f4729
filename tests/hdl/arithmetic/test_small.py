"""Counting bits and comparing colours, every case."""

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike
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
