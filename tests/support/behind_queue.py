"""Blocks that pass on what a queue offers, for checkers that must find logic between."""

from abc import abstractmethod

from amaranth.hdl import Module
from amaranth.lib import stream
from amaranth.lib.wiring import Component, In, Out

from softdepth.hdl.memory.item_queue import ItemQueue


class BehindQueue(Component):
    """An `ItemQueue` of two bits with logic at its output."""

    i: In(stream.Signature(2))
    o: Out(stream.Signature(2))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.queue = queue = ItemQueue(2)
        m.d.comb += [
            queue.i.valid.eq(self.i.valid),
            queue.i.payload.eq(self.i.payload),
            self.i.ready.eq(queue.i.ready),
            queue.o.ready.eq(self.o.ready),
            *self.given(queue),
        ]
        return m

    @abstractmethod
    def given(self, queue: ItemQueue) -> list:
        """What `o` offers."""
