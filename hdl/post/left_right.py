"""Whether the right view agrees with the left."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal
from amaranth.lib import data, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.signatures import TOLERANCE_BITS


class LeftRight(wiring.Component):
    """Compares each left winner with the winner of the right pixel that it chose.

    The right winner of a slot's column is known ``disparities - 1`` slots later. So left results wait that
    long, and the right winners of as many columns are kept. A slot a clock.

    Parameters
    ----------
    result : what waits with a left winner.
    tolerance : the largest difference that agrees.

    Members
    -------
    valid : a slot's results are there.
    emits, winner, result : of the slot: whether it has a result, the left winner, and what belongs to it.
    right : the right winner that leaves with the slot.
    tolerance : as the parameter, which is its value where it is not driven. It may change between frames.
    done : one slot's results are judged, `latency` clocks later, whether it has any or not.
    o_emits, agrees, o : it has, the views agree, and what belonged to it.
    """

    latency = 2

    def __init__(self, disparities: int, result: ShapeLike, tolerance: int) -> None:
        self._disparities, self._result = disparities, result
        winner = range(disparities)
        super().__init__(
            {
                "valid": In(1),
                "emits": In(1),
                "winner": In(winner),
                "result": In(result),
                "right": In(winner),
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
        waiting = data.StructLayout({"emits": 1, "winner": range(disparities), "result": self._result})
        m.submodules.waits = waits = Delay(waiting, disparities - 1)
        m.d.comb += [
            waits.en.eq(self.valid),
            waits.i.emits.eq(self.emits),
            waits.i.winner.eq(self.winner),
            waits.i.result.eq(self.result),
        ]
        # What waits from before a reset is no result.
        slots = Signal(range(disparities))
        warm = Signal()
        m.d.comb += warm.eq(slots == disparities - 1)
        with m.If(self.valid & ~warm):
            m.d.sync += slots.eq(slots + 1)

        m.submodules.rights = rights = Memory(shape=range(disparities), depth=1 << bits, init=[])
        write, read = rights.write_port(), rights.read_port(domain="comb")
        column = Signal(bits)
        with m.If(self.valid):
            m.d.sync += column.eq(column + 1)
        taken = Signal()
        left = Signal(waiting, reset_less=True)
        left_emits = Signal()
        left_column = Signal(bits, reset_less=True)
        m.d.comb += [
            write.en.eq(self.valid),
            write.addr.eq(column),
            write.data.eq(self.right),
            read.addr.eq(left_column - left.winner),
        ]
        m.d.sync += [taken.eq(self.valid), left_emits.eq(self.valid & waits.o.emits & warm)]
        with m.If(self.valid):
            m.d.sync += [left.eq(waits.o), left_column.eq(column)]
        done, emits, agrees = Signal(), Signal(), Signal(reset_less=True)
        result = Signal(self._result, reset_less=True)
        difference = read.data - left.winner
        m.d.sync += [
            done.eq(taken),
            emits.eq(left_emits),
            agrees.eq(Mux(difference[-1], -difference, difference) <= self.tolerance),
            result.eq(left.result),
        ]
        m.d.comb += [
            self.done.eq(done),
            self.o_emits.eq(emits),
            self.agrees.eq(agrees),
            self.o.eq(result),
        ]
        return m
