"""Whether the right view agrees with the left."""

from amaranth.hdl import Module, ShapeLike, Signal
from amaranth.lib import data, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.delay import Delay, delayed
from softdepth.hdl.signatures import TOLERANCE_BITS


class LeftRight(wiring.Component):
    """Compares each left winner with the winner of the right pixel that it chose.

    The right winner of a slot's column is known ``disparities - 1`` slots later. Left results wait for as
    long, and the right winners of as many columns are kept. One slot a clock.

    A winner comes `lead` clocks before the rest of its slot, which is still being computed. In these clocks
    the right winner is addressed, read and subtracted, a clock each.

    Parameters
    ----------
    result : what waits together with a left winner.
    tolerance : the largest difference that counts as agreement.

    Members
    -------
    valid, winner, right : a slot's left winner, and the right winner that leaves with it.
    emits, result : `lead` clocks later: whether the slot has a result, and what belongs to it.
    tolerance : the parameter's value unless it is driven. It may change between frames.
    done : a slot has been judged, `lead` and `latency` clocks later, whether or not it has a result.
    o_emits, agrees, o : whether the slot has a result, whether the views agree, and what belongs to it.
    """

    lead = 4
    latency = 1

    def __init__(self, disparities: int, result: ShapeLike, tolerance: int) -> None:
        self._disparities, self._result = disparities, result
        winner = range(disparities)
        super().__init__(
            {
                "valid": In(1),
                "winner": In(winner),
                "right": In(winner),
                "emits": In(1),
                "result": In(result),
                "tolerance": In(TOLERANCE_BITS, init=tolerance),
                "done": Out(1),
                "o_emits": Out(1),
                "agrees": Out(1),
                "o": Out(result),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        disparities = self._disparities
        bits = (disparities - 1).bit_length()
        valid = travelling(m, self.valid, self.lead, "valid")

        # Clock 1: the left winner. Clock 2: where its right winner lies. Clock 3: that right winner. Clock 4:
        # the difference. A right winner is written a clock late, after the oldest one's place has been read.
        m.submodules.winners = winners = Delay(range(disparities), disparities - 1, registers=False)
        m.d.comb += [winners.en.eq(self.valid), winners.i.eq(self.winner)]
        m.submodules.rights = rights = Memory(shape=range(disparities), depth=1 << bits, init=[])
        write = rights.write_port()
        read = rights.read_port(domain="comb")
        column = Signal(bits)
        left = Signal(range(disparities), reset_less=True)
        left_column = Signal(bits, reset_less=True)
        new = Signal(range(disparities), reset_less=True)
        with m.If(self.valid):
            m.d.sync += [
                column.eq(column + 1),
                left.eq(winners.o),
                left_column.eq(column),
                new.eq(self.right),
            ]
        place = Signal(bits, reset_less=True)
        right = Signal(range(disparities), reset_less=True)
        left_late = delayed(m, left, 2, "left")
        difference = Signal((right - left_late).shape(), reset_less=True)
        m.d.comb += [
            write.en.eq(valid[1]),
            write.addr.eq(left_column),
            write.data.eq(new),
            read.addr.eq(place),
        ]
        m.d.sync += [
            place.eq(left_column - left),
            right.eq(read.data),
            difference.eq(right - left_late),
        ]
        too_small = (difference + self.tolerance)[-1]
        too_large = (self.tolerance - difference)[-1]

        waiting = data.StructLayout({"emits": 1, "result": self._result})
        m.submodules.waits = waits = Delay(waiting, disparities - 1)
        m.d.comb += [
            waits.en.eq(valid[self.lead]),
            waits.i.emits.eq(self.emits),
            waits.i.result.eq(self.result),
        ]
        # Whatever was waiting before a reset is not a result.
        slots = Signal(range(disparities))
        warm = Signal()
        m.d.comb += warm.eq(slots == disparities - 1)
        with m.If(valid[self.lead] & ~warm):
            m.d.sync += slots.eq(slots + 1)

        # The memory's output goes only to registers, which may be the memory's own.
        done = Signal()
        counts = Signal()
        agrees = Signal(reset_less=True)
        emits = Signal(reset_less=True)
        leaving = Signal(self._result, reset_less=True)
        m.d.sync += [
            done.eq(valid[self.lead]),
            counts.eq(valid[self.lead] & warm),
            emits.eq(waits.o.emits),
            agrees.eq(~(too_small | too_large)),
            leaving.eq(waits.o.result),
        ]
        m.d.comb += [
            self.done.eq(done),
            self.o_emits.eq(emits & counts),
            self.agrees.eq(agrees),
            self.o.eq(leaving),
        ]
        return m
