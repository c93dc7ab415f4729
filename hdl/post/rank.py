"""The lower median of some of many samples."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.popcount import popcount
from softdepth.hdl.memory.delay import Delay

SOON = 4
"""Clocks that a bit waits in registers."""


class LowerMedian(wiring.Component):
    """Of the samples that are kept the one of rank ``(number - 1) >> 1`` in ascending order, one set a clock.

    Found bit by bit from the top: of the samples that may still be it, those whose bit is 0 are counted.
    If there are more than the rank, it is among them; else it is among the others, and the rank falls by
    their number. No sample is ever moved. A clock counts and a clock decides, for each bit: a bit waits in
    distributed RAM until its turn comes, where that is not soon.

    Parameters
    ----------
    samples : how many there are.
    bits : of a sample.
    all_kept : all of them always are, and there is no ``keep``.

    Members
    -------
    i : the samples.
    keep : a bit each; one at least is set, or the result says nothing.
    o : the median, `latency` clocks later.
    """

    def __init__(self, samples: int, bits: int, *, all_kept: bool = False) -> None:
        self._samples, self._bits, self._all_kept = samples, bits, all_kept
        self.latency = 2 * bits
        ports = {"i": In(data.ArrayLayout(unsigned(bits), samples)), "o": Out(bits)}
        super().__init__(ports if all_kept else {**ports, "keep": In(samples)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count_shape = range(self._samples + 1)
        may: Value = ~Signal(self._samples, name="none") if self._all_kept else self.keep
        rank: Value | None = None
        found: list[Value] = []
        for bit in reversed(range(self._bits)):
            zeros, kept = (Signal(count_shape, name=f"{n}_{bit}", reset_less=True) for n in ("zeros", "kept"))
            held_may = Signal(self._samples, name=f"held_{bit}", reset_less=True)
            turn = 2 * (self._bits - 1 - bit)
            m.submodules[f"wait_{bit}"] = wait = Delay(self._samples, turn, registers=turn <= SOON)
            m.d.comb += [wait.en.eq(1), wait.i.eq(Cat(self.i[k][bit] for k in range(self._samples)))]
            tops = wait.o
            held_tops = Signal(self._samples, name=f"tops_{bit}", reset_less=True)
            m.d.sync += [
                zeros.eq(popcount(m, may & ~tops)),
                held_may.eq(may),
                held_tops.eq(tops),
            ]
            if rank is None:
                if self._all_kept:
                    m.d.comb += kept.eq(self._samples)
                else:
                    m.d.sync += kept.eq(popcount(m, may))
                held_rank: Value = (kept - 1)[: len(kept)] >> 1
            else:
                held_rank = Signal(count_shape, name=f"held_rank_{bit}", reset_less=True)
                m.d.sync += held_rank.eq(rank)
            is_one = Signal(name=f"is_one_{bit}")
            m.d.comb += is_one.eq(~(held_rank - zeros)[-1])  # the rank is not below the zeros
            below = Signal(count_shape, name=f"rank_{bit}", reset_less=True)
            following_may = Signal(self._samples, name=f"may_{bit}", reset_less=True)
            m.d.sync += [
                below.eq(Mux(is_one, held_rank - zeros, held_rank)),
                following_may.eq(held_may & ~(held_tops ^ is_one.replicate(self._samples))),
            ]
            so_far = Cat(is_one, *found)
            held_found = [Signal(name=f"found_{bit}_{k}", reset_less=True) for k in range(len(found))]
            m.d.sync += [h.eq(f) for h, f in zip(held_found, found, strict=True)]
            result = Signal(len(so_far), name=f"result_{bit}", reset_less=True)
            m.d.sync += result.eq(Cat(is_one, *held_found))
            found, rank = list(result), below
            may = following_may
        m.d.comb += self.o.eq(Cat(*found))
        return m
