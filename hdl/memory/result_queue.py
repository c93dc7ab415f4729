"""The queue at a free-running pipeline's end, and the credits that keep it from overflowing."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.level import Level

QUEUE_LATENCY = 2
"""Clocks from a write to the output."""


class ResultQueue(wiring.Component):
    """Lets a pipeline that cannot stop end in a stream that may be held back.

    Each result is promised a place when its computation begins. More may begin only while places are
    left, so back-pressure reaches the pipeline's input, and nothing inside needs an enable. One result
    a clock.

    Parameters
    ----------
    shape : of a result.
    latency : clocks from a promise to its `put`.
    unseen : results that may begin while credit, or the promises of others, are still on their way: places
        are kept free for these.

    Members
    -------
    depth : results that there are places for.
    credit : a result may be promised in this clock.
    promised : a result is promised.
    dropped : a result that was promised will not come.
    put, result : a promised result arrives.
    o : the results, in order.
    """

    def __init__(self, shape: ShapeLike, latency: int, *, unseen: int = 0) -> None:
        self._shape, self._unseen = shape, unseen
        self.depth = latency + QUEUE_LATENCY + 2 + unseen
        super().__init__(
            {
                "credit": Out(1),
                "promised": In(1),
                "dropped": In(1),
                "put": In(1),
                "result": In(shape),
                "o": Out(stream.Signature(shape)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        depth = self.depth
        result = Value.cast(self.result)
        taken = Signal()
        m.d.comb += taken.eq(self.o.valid & self.o.ready)

        # The output is a register that takes what comes next whenever it may, so a full queue has one place
        # more than its memory. Whatever is written was promised a place, so nothing checks for one.
        places = depth - 1
        m.submodules.memory = memory = Memory(shape=len(result), depth=places, init=[])
        write = memory.write_port()
        read = memory.read_port()
        write_at = Signal(range(places))
        read_at = Signal(range(places))
        holding = Signal()  # there is one in the output
        moves = Signal()  # one of them gets there
        free = Signal()
        some = Level(m, places, self.put, moves).some
        m.d.comb += [
            free.eq(~holding | self.o.ready),
            moves.eq(some & free),
            write.en.eq(self.put),
            write.addr.eq(write_at),
            write.data.eq(result),
            read.en.eq(moves),
            read.addr.eq(read_at),
            self.o.valid.eq(holding),
            Value.cast(self.o.payload).eq(read.data),
        ]
        for happens, at in ((self.put, write_at), (moves, read_at)):
            with m.If(happens):
                m.d.sync += at.eq(Mux(at == places - 1, 0, at + 1))
        with m.If(free):
            m.d.sync += holding.eq(some)

        # Credit is a register. A promise comes late in its clock and takes a place at once; places given back
        # wait for a clock: so no path leads from ``o.ready`` to ``credit``, nor through an adder to it.
        left = Signal(range(depth + 1), init=depth)
        back = Signal(2)
        counted = Signal.like(left)
        credit = Signal(init=1)
        m.d.comb += [counted.eq(left + back), self.credit.eq(credit)]
        m.d.sync += [
            back.eq(self.dropped + taken),
            left.eq(Mux(self.promised, counted - 1, counted)),
            credit.eq(Mux(self.promised, counted > self._unseen + 1, counted > self._unseen)),
        ]
        return m
