"""The board's end of the conversation: which packet is the next, what it asks, and its reply."""

from amaranth.hdl import Array, Cat, Const, Module, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import Config
from softdepth.hdl.boards.result_store import SLOTS
from softdepth.hdl.signatures import COUNTER_BITS
from softdepth.protocol import (
    PAIR_BYTES,
    REPLY,
    ROW,
    SIZE,
    VERSION,
    WINDOW,
    Reason,
    Repeat,
    Type,
    result_bytes,
)

Reply = data.StructLayout({"type": 8, "has_line": 1, "slot": range(SLOTS), "row": 16})
"""What makes a reply: kept for each of the last `WINDOW` requests, to be made again."""


class Session(wiring.Component):
    """Takes sound packets in their order, and decides what to do and what to answer.

    A request of the awaited sequence number is carried out. One of the `WINDOW` before it is answered
    again, and changes nothing. Any other, and a broken packet, calls for a repetition. The request after
    the next confirms a reply, and so frees its line of results.

    Members
    -------
    good, bad, version, type, sequence, length : of the packet that ended, from the parser.
    payload_valid, payload : bytes of its payload.
    restart : a session begins: everything behind the link is reset.
    begin, width, height : a frame begins, and its size.
    feed : the line that came is sound, and enters the core.
    feeding, fed : the line before it is still entering; the frame's last has entered.
    overrun : the line that came is spoilt.
    ready, slot, claim, release : of the result store.
    fault : of the result store.
    start, sending : the reply is to be sent; the sender is at it.
    reply, reply_sequence, reply_length : the reply, steady while it is sent.
    note : reason of an error or repetition, in its payload.
    counters : packets, broken, gaps, overruns; saturating.
    receiving, troubled : a packet came; something was wrong with it. In this clock only.
    active : a frame is under way.
    """

    def __init__(self, config: Config, hello_bytes: int, counter_bytes: int) -> None:
        self._config = config
        self._lengths = {Type.HELLO: hello_bytes, Type.STATUS: counter_bytes, Type.REPEAT: 1, Type.ERROR: 1}
        super().__init__(
            {
                "good": In(1),
                "bad": In(1),
                "version": In(8),
                "type": In(8),
                "sequence": In(16),
                "length": In(16),
                "payload_valid": In(1),
                "payload": In(8),
                "restart": Out(1),
                "begin": Out(1),
                "width": Out(range(config.max_width + 1)),
                "height": Out(range(config.max_height + 1)),
                "feed": Out(1),
                "feeding": In(1),
                "fed": In(1),
                "overrun": In(1),
                "ready": In(1),
                "slot": In(range(SLOTS)),
                "claim": Out(1),
                "release": Out(1),
                "fault": In(1),
                "start": Out(1),
                "sending": In(1),
                "reply": Out(Reply),
                "reply_sequence": Out(16),
                "reply_length": Out(16),
                "note": Out(8),
                "counters": Out(data.ArrayLayout(COUNTER_BITS, 4)),
                "receiving": Out(1),
                "troubled": Out(1),
                "active": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        started = Signal()
        awaited = Signal(16)
        behind = Signal(16)
        kept = Array(Signal(Reply, name=f"kept_{k}") for k in range(WINDOW))
        pending = Signal()  # a reply waits for the sender
        answer = Signal(Reply)
        answered = Signal()
        sequence = Signal(16)
        note = Signal(8)
        self._rows_left = Signal.like(self.height)  # results of the frame that are not claimed
        packets, broken, gaps, overruns = range(4)
        event = Signal(4)

        tail = Signal(8 * SIZE.size)  # the payload's last bytes
        with m.If(self.payload_valid):
            m.d.sync += tail.eq(Cat(tail[8:], self.payload))
        width, height = tail[:16], tail[16:]

        m.d.comb += [
            behind.eq(awaited - self.sequence),
            sequence.eq(self.sequence),
            self.active.eq(self._rows_left != 0),
            self.receiving.eq(self.good | self.bad),
            self.troubled.eq(
                event[broken]
                | event[gaps]
                | event[overruns]
                | (answered & (answer.type == (REPLY | Type.ERROR)))
            ),
        ]

        def refuse(reason: Reason) -> None:
            m.d.comb += [answered.eq(1), answer.type.eq(REPLY | Type.ERROR), note.eq(reason)]

        def repeat(why: Repeat) -> None:
            m.d.comb += [
                answered.eq(1),
                answer.type.eq(REPLY | Type.REPEAT),
                note.eq(why),
                sequence.eq(awaited),
            ]

        def accept() -> None:
            """Carry a request out: its reply takes the place of one that is now confirmed."""
            old = kept[self.sequence[: (WINDOW - 1).bit_length()]]
            m.d.comb += [answered.eq(1), answer.type.eq(REPLY | self.type), self.release.eq(old.has_line)]
            m.d.sync += [awaited.eq(self.sequence + 1), old.eq(answer)]

        def accept_with_line() -> None:
            accept()
            with m.If(self.ready):
                m.d.comb += [
                    self.claim.eq(1),
                    answer.has_line.eq(1),
                    answer.slot.eq(self.slot),
                    answer.row.eq(self.height - self._rows_left),
                ]
                m.d.sync += self._rows_left.eq(self._rows_left - 1)

        with m.If(self.bad & ~pending):
            m.d.comb += event[broken].eq(1)
            with m.If(started):
                repeat(Repeat.BROKEN)
        with m.Elif(self.bad):
            m.d.comb += event[broken].eq(1)
        with m.Elif(self.good & pending):
            # The reply before is not even begun: the host does not keep to the window. It may ask again.
            m.d.comb += event[overruns].eq(1)
        with m.Elif(self.good):
            m.d.comb += event[packets].eq(1)
            with m.If(self.version != VERSION):
                refuse(Reason.VERSION)
            with m.Elif(self.type == Type.HELLO):
                m.d.comb += [self.restart.eq(1), answered.eq(1), answer.type.eq(REPLY | Type.HELLO)]
                m.d.sync += [awaited.eq(self.sequence + 1), started.eq(1), self._rows_left.eq(0)]
                m.d.sync += [reply.eq(Const(0, Reply.size)) for reply in kept]
                m.d.sync += kept[self.sequence[: (WINDOW - 1).bit_length()]].type.eq(REPLY | Type.HELLO)
            with m.Elif(~started):
                refuse(Reason.SESSION)
            with m.Elif((behind >= 1) & (behind <= WINDOW)):
                m.d.comb += [answered.eq(1), answer.eq(kept[self.sequence[: (WINDOW - 1).bit_length()]])]
            with m.Elif(behind != 0):
                m.d.comb += event[gaps].eq(1)
                repeat(Repeat.GAP)
            with m.Elif(self.fault):
                refuse(Reason.CORE)
            with m.Elif(self.type == Type.BEGIN):
                low, high = self._config.min_width, self._config.max_width
                with m.If(self.active | (self.length != SIZE.size)):
                    refuse(Reason.ORDER)
                with m.Elif(
                    (width < low) | (width > high) | (height < 1) | (height > self._config.max_height)
                ):
                    refuse(Reason.SIZE)
                with m.Else():
                    accept()
                    m.d.comb += self.begin.eq(1)
                    m.d.sync += [self.width.eq(width), self.height.eq(height), self._rows_left.eq(height)]
            with m.Elif(self.type == Type.LINE):
                with m.If(~self.active | self.fed | (self.length != self.width * PAIR_BYTES)):
                    refuse(Reason.ORDER)
                with m.Elif(self.overrun | self.feeding):
                    m.d.comb += event[overruns].eq(1)
                    repeat(Repeat.BROKEN)
                with m.Else():
                    accept_with_line()
                    m.d.comb += self.feed.eq(1)
            with m.Elif(self.type == Type.FETCH):
                accept_with_line()
            with m.Elif(self.type == Type.STATUS):
                accept()
            with m.Else():
                refuse(Reason.TYPE)

        self._count(m, event)
        self._send(m, pending, answered, answer, sequence, note)
        return m

    def _count(self, m: Module, event: Signal) -> None:
        for k, counter in enumerate(self.counters):
            with m.If(event[k] & (counter != 2**COUNTER_BITS - 1)):
                m.d.sync += counter.eq(counter + 1)
            with m.If(self.restart):
                m.d.sync += counter.eq(0)

    def _send(self, m: Module, pending: Signal, answered: Signal, answer: data.View, *rest: Signal) -> None:
        """A reply that was decided on goes out when the one before it has gone."""
        sequence, note = rest
        waiting = Signal(Reply)
        waiting_sequence, waiting_note = Signal(16), Signal(8)
        with m.If(answered):
            m.d.sync += [
                pending.eq(1),
                waiting.eq(answer),
                waiting_sequence.eq(sequence),
                waiting_note.eq(note),
            ]
        with m.If(pending & ~self.sending & ~self.start):
            m.d.sync += [
                self.start.eq(1),
                self.reply.eq(waiting),
                self.reply_sequence.eq(waiting_sequence),
                self.note.eq(waiting_note),
                self.reply_length.eq(0),
            ]
            m.d.sync += pending.eq(0)
            with m.Switch(waiting.type):
                for kind, length in self._lengths.items():
                    with m.Case(REPLY | kind):
                        m.d.sync += self.reply_length.eq(length)
            with m.If(waiting.has_line):
                m.d.sync += self.reply_length.eq(self.width * result_bytes(self._config) + ROW.size)
        with m.Else():
            m.d.sync += self.start.eq(0)
