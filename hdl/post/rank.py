"""The lower median of some of many samples."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.popcount import popcount
from softdepth.hdl.memory.delay import Delay, delayed

SOON = 4
"""Clocks that a bit waits in registers."""


def median_latency(bits: int, *, all_kept: bool = False) -> int:
    """Of a `LowerMedian`."""
    return 2 * bits + (not all_kept)


class LowerMedian(wiring.Component):
    """Of the kept samples, the one of rank ``(number - 1) >> 1`` in ascending order. One set a clock.

    It is found bit by bit from the top. Among the samples that may still be the median, those with a 0 in
    the current bit are counted. If their number is larger than the rank, the median is one of them. Otherwise
    it is one of the rest, and their number is subtracted from the rank. No sample is ever moved. Each bit
    takes one clock to count, each half by itself, and one to add and decide; bits whose turn is far off wait
    in distributed RAM. If not all samples are kept, one more clock counts those that are.

    Parameters
    ----------
    samples : how many there are.
    bits : of a sample.
    all_kept : all samples are always kept, and there is no ``keep``.

    Members
    -------
    i : the samples.
    keep : a bit for each sample; at least one must be set, or the result means nothing.
    o : the median, `latency` clocks later.
    """

    def __init__(self, samples: int, bits: int, *, all_kept: bool = False) -> None:
        self._samples, self._bits, self._all_kept = samples, bits, all_kept
        self.latency = median_latency(bits, all_kept=all_kept)
        ports = {"i": In(data.ArrayLayout(unsigned(bits), samples)), "o": Out(bits)}
        super().__init__(ports if all_kept else {**ports, "keep": In(samples)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count_shape = range(self._samples + 1)
        may: Value = ~Signal(self._samples, name="none") if self._all_kept else self.keep
        rank: Value = Const(self._samples - 1 >> 1, count_shape)
        first = median_latency(0, all_kept=self._all_kept)
        if first:
            # The kept ones are counted before anything else.
            parts = self._counted(m, may, "kept")
            rank = Signal(count_shape, name="first_rank", reset_less=True)
            may = delayed(m, may, 1, "kept")
            m.d.sync += rank.eq((parts[0] + parts[1] - 1)[: len(rank)] >> 1)
        found: list[Value] = []
        for bit in reversed(range(self._bits)):
            held_may = Signal(self._samples, name=f"held_{bit}", reset_less=True)
            turn = first + 2 * (self._bits - 1 - bit)
            m.submodules[f"wait_{bit}"] = wait = Delay(self._samples, turn, registers=turn <= SOON)
            m.d.comb += [wait.en.eq(1), wait.i.eq(Cat(self.i[k][bit] for k in range(self._samples)))]
            tops = wait.o
            held_tops = Signal(self._samples, name=f"tops_{bit}", reset_less=True)
            parts = self._counted(m, may & ~tops, f"zeros_{bit}")
            zeros = Signal(count_shape, name=f"zeros_{bit}")
            m.d.comb += zeros.eq(parts[0] + parts[1])
            m.d.sync += [held_may.eq(may), held_tops.eq(tops)]
            held_rank: Value = rank
            if found:
                held_rank = delayed(m, rank, 1, f"held_rank_{bit}")
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
            upper = Signal(len(so_far), name=f"from_{bit}_up", reset_less=True)
            m.d.sync += upper.eq(Cat(is_one, *held_found))
            found, rank = list(upper), below
            may = following_may
        m.d.comb += self.o.eq(Cat(*found))
        return m

    def _counted(self, m: Module, bits: Value, name: str) -> list[Value]:
        """How many bits are set, a clock later, as two numbers that are still to be added."""
        half = self._samples // 2
        counts: list[Value] = []
        for part in (bits[:half], bits[half:]):
            count = Signal(range(len(part) + 1), name=f"{name}_{len(counts)}", reset_less=True)
            m.d.sync += count.eq(popcount(m, part))
            counts.append(count)
        return counts
