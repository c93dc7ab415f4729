"""A queue of many thousand items, in parts."""

from amaranth.hdl import Module
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.packed_memory import SEGMENTS
from softdepth.hdl.memory.packed_queue import PackedQueue

PART = max(SEGMENTS)
"""Items of a part, few enough that it need not choose between block RAMs of different addresses."""


class LongQueue(wiring.Component):
    """`PackedQueue`s one behind the other, each no deeper than `PART`. An item a clock.

    Parameters
    ----------
    shape : of an item.
    depth : items that wait, at least.

    Members
    -------
    i, o : the items, in order, `latency` clocks later if none waits.
    """

    def __init__(self, shape: data.StructLayout, depth: int) -> None:
        whole, rest = divmod(depth, PART)
        depths = [PART] * whole + [rest] * bool(rest)
        self._parts = [PackedQueue(shape, deep) for deep in depths]
        self.latency = PackedQueue.latency * len(depths)
        super().__init__({"i": In(stream.Signature(shape)), "o": Out(stream.Signature(shape))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        items = wiring.flipped(self.i)
        for number, part in enumerate(self._parts):
            m.submodules[f"part_{number}"] = part
            wiring.connect(m, items, part.i)
            items = part.o
        wiring.connect(m, items, wiring.flipped(self.o))
        return m
