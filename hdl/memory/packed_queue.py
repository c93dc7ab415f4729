"""A long queue in as few block RAMs as its depth allows."""

from amaranth.hdl import Module, ShapeLike, Signal, Value, unsigned
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.level import Level
from softdepth.hdl.memory.packed_memory import PackedMemory
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY, ResultQueue


class PackedQueue(wiring.Component):
    """Lets items wait in a `PackedMemory`, whose blocks use their output registers. An item a clock.

    Behind the memory, a short queue takes what was read; no path leads from one block to another.

    Parameters
    ----------
    shape : of an item.
    depth : items that can wait, at least.

    Members
    -------
    i, o : the items, in order.
    """

    latency = 1 + PackedMemory.latency + QUEUE_LATENCY
    """Clocks from an item's transfer to when it is on offer."""

    def __init__(self, shape: ShapeLike, depth: int) -> None:
        self._shape, self._depth = shape, depth
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        depth = self._depth
        new = Value.cast(self.i.payload)
        m.submodules.memory = memory = PackedMemory(unsigned(len(new)), depth)
        m.submodules.queue = queue = ResultQueue(self._shape, PackedMemory.latency)
        write_at = Signal(range(depth))
        read_at = Signal(range(depth))
        puts = Signal()
        takes = Signal()
        level = Level(m, depth, puts, takes)
        m.d.comb += [
            self.i.ready.eq(level.room),
            puts.eq(self.i.valid & level.room),
            takes.eq(level.some & queue.credit),
        ]
        for happens, at in ((puts, write_at), (takes, read_at)):
            with m.If(happens):
                m.d.sync += at.eq(at + 1)
                with m.If(at == depth - 1):
                    m.d.sync += at.eq(0)
        m.d.comb += [
            memory.write.eq(puts),
            memory.write_at.eq(write_at),
            memory.written.eq(new),
            memory.read.eq(takes),
            memory.read_at.eq(read_at),
            queue.promised.eq(takes),
            queue.put.eq(travelling(m, takes, PackedMemory.latency, "taken")[-1]),
            Value.cast(queue.result).eq(memory.data),
        ]
        wiring.connect(m, queue.o, wiring.flipped(self.o))
        return m
