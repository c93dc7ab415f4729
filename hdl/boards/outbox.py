"""The outbox: a reply that waits for the sender, and what the sender needs to know about it."""

from collections.abc import Mapping

from amaranth.hdl import Module, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.result_store import SLOTS
from softdepth.spec.config import Config
from softdepth.spec.protocol import REPLY, ROW, Type, result_bytes

Reply = data.StructLayout({"type": 8, "has_line": 1, "slot": range(SLOTS), "row": 16})
"""A reply as it is kept for sending again: its type, and the line of results in it."""

Letter = data.StructLayout({"reply": Reply, "sequence": 16, "note": 8})
"""A reply with its address; ``note`` is the reason for an error or a repetition."""


class Outbox(wiring.Component):
    """Holds one reply until the one before it has been sent.

    Parameters
    ----------
    lengths : bytes of the payload by type, where their number is fixed and not 0.

    Members
    -------
    post, i : a reply is put in; not while ``full``.
    full : a reply waits.
    width : of the frame, in pixels.
    start, sending : the reply ``o`` is to be sent; the sender is busy with it.
    o, length : the reply, and the bytes of its payload; steady while it is sent.
    """

    def __init__(self, config: Config, lengths: Mapping[Type, int]) -> None:
        self._config = config
        self._lengths = lengths
        super().__init__(
            {
                "post": In(1),
                "i": In(Letter),
                "full": Out(1),
                "width": In(range(config.max_width + 1)),
                "start": Out(1),
                "sending": In(1),
                "o": Out(Letter),
                "length": Out(16),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        waiting = Signal(Letter)
        line_length = Signal(16)
        m.d.sync += [
            line_length.eq(self.width * result_bytes(self._config) + ROW.size),
            self.start.eq(0),
        ]
        with m.If(self.full & ~self.sending & ~self.start):
            m.d.sync += [self.start.eq(1), self.full.eq(0), self.o.eq(waiting), self.length.eq(0)]
            with m.Switch(waiting.reply.type):
                for kind, length in self._lengths.items():
                    with m.Case(REPLY | kind):
                        m.d.sync += self.length.eq(length)
            with m.If(waiting.reply.has_line):
                m.d.sync += self.length.eq(line_length)
        with m.If(self.post):
            m.d.sync += [self.full.eq(1), waiting.eq(self.i)]
        return m
