"""What is known of an item when it passes, kept until its result leaves."""

from amaranth.hdl import Const, Module, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.long_queue import LongQueue


class Kept(wiring.Component):
    """Keeps one member of each item that passes, in a queue in block RAM.

    Items pass in the same clock, and wait when the queue is full. An item whose ``end`` is set has no pixel
    and no result, so nothing of it is kept.

    Parameters
    ----------
    layout : of the items.
    member : the one that is kept.
    places : how many items can pass before the first one's result is needed.

    Members
    -------
    i, o : the items.
    kept : a stream of the member, in the same order.
    """

    def __init__(self, layout: data.StructLayout, member: str, places: int) -> None:
        self._layout, self._member, self._places = layout, member, places
        super().__init__(
            {
                "i": In(stream.Signature(layout)),
                "o": Out(stream.Signature(layout)),
                "kept": Out(stream.Signature(layout.members[member])),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        item = self.i.payload
        word = data.StructLayout({self._member: self._layout.members[self._member]})
        m.submodules.queue = queue = LongQueue(word, self._places)
        bare: Value = item.end if "end" in self._layout.members else Const(0)
        m.d.comb += [
            self.o.payload.eq(item),
            self.o.valid.eq(self.i.valid & queue.i.ready),
            self.i.ready.eq(self.o.ready & queue.i.ready),
            queue.i.valid.eq(self.i.valid & self.o.ready & ~bare),
            queue.i.payload[self._member].eq(item[self._member]),
            self.kept.payload.eq(queue.o.payload[self._member]),
            self.kept.valid.eq(queue.o.valid),
            queue.o.ready.eq(self.kept.ready),
        ]
        return m
