"""The board's end of the conversation: which packet comes next, what it asks for, and the reply."""

from amaranth.hdl import Array, Cat, Const, Module, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.outbox import Letter, Reply
from softdepth.hdl.boards.result_store import SLOTS
from softdepth.hdl.signatures import COUNTER_BITS
from softdepth.spec.config import Config
from softdepth.spec.protocol import REPLY, SIZE, VERSION, WINDOW, Reason, Repeat, Type, pair_bytes

PACKETS, BROKEN, GAPS, OVERRUNS = range(4)


class Session(wiring.Component):
    """Takes sound packets in order, and decides what to do and what to answer.

    A request with the awaited sequence number is carried out. One of the `WINDOW` before it is answered
    again and changes nothing. For any other, and for a broken packet, the board asks for a repetition. A
    reply is confirmed by the request after the next, which frees its line of results.

    Members
    -------
    good, bad, version, type, sequence, length : of the packet that has ended, from the parser.
    payload_valid, payload : bytes of its payload.
    restart : a session begins: everything behind the link is reset.
    begin, width, height : a frame begins, and its size.
    feed : the line that has come is sound and enters the core.
    feeding, fed : the line before it is still entering; the frame's last line has entered.
    overrun : the line that has come is spoilt.
    ready, slot, claim, release : of the result store.
    fault : of the result store.
    post, letter, full : of the outbox.
    counters : packets, broken, gaps, overruns; saturating.
    receiving, troubled : a packet came, a clock after ``good`` or ``bad``; something was wrong with it.
    active : a frame is under way.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
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
                "post": Out(1),
                "letter": Out(Letter),
                "full": In(1),
                "counters": Out(data.ArrayLayout(COUNTER_BITS, 4)),
                "receiving": Out(1),
                "troubled": Out(1),
                "active": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # Packets are far apart, so there is time to register what is worked out about them.
        good = Signal()
        bad = Signal()
        awaited = Signal(16)
        behind = Signal(16)
        m.d.sync += [good.eq(self.good), bad.eq(self.bad), behind.eq(awaited - self.sequence)]
        started = Signal()
        event = Signal(4)
        refused = Signal()
        self._event, self._refused = event, refused
        self._awaited = awaited
        self._kept = Array(Signal(Reply, name=f"kept_{k}") for k in range(WINDOW))
        self._rows_left = Signal.like(self.height)  # results of the frame that are not claimed
        self._examine(m)
        old = self._kept[self.sequence[: (WINDOW - 1).bit_length()]]
        m.d.comb += [
            self.letter.sequence.eq(self.sequence),
            self.active.eq(self._rows_left != 0),
            self.receiving.eq(good | bad),
            self.troubled.eq(event[BROKEN] | event[GAPS] | event[OVERRUNS] | refused),
        ]
        with m.If(bad):
            m.d.comb += event[BROKEN].eq(1)
            with m.If(started & ~self.full):
                self._repeat(m, Repeat.BROKEN)
        with m.Elif(good & self.full):
            # Not even the previous reply has begun: the host does not keep to the window. It may ask again.
            m.d.comb += event[OVERRUNS].eq(1)
        with m.Elif(good):
            m.d.comb += event[PACKETS].eq(1)
            with m.If(self.version != VERSION):
                self._refuse(m, Reason.VERSION)
            with m.Elif(self.type == Type.HELLO):
                m.d.comb += [
                    self.restart.eq(1),
                    self.post.eq(1),
                    self.letter.reply.type.eq(REPLY | Type.HELLO),
                ]
                m.d.sync += [awaited.eq(self.sequence + 1), started.eq(1), self._rows_left.eq(0)]
                m.d.sync += [reply.eq(Const(0, Reply.size)) for reply in self._kept]
                m.d.sync += old.type.eq(REPLY | Type.HELLO)
            with m.Elif(~started):
                self._refuse(m, Reason.SESSION)
            with m.Elif((behind >= 1) & (behind <= WINDOW)):
                m.d.comb += [self.post.eq(1), self.letter.reply.eq(old)]
            with m.Elif(behind != 0):
                m.d.comb += event[GAPS].eq(1)
                self._repeat(m, Repeat.GAP)
            with m.Elif(self.fault):
                self._refuse(m, Reason.CORE)
            with m.Else():
                self._carry_out(m, old)

        for k, counter in enumerate(self.counters):
            with m.If(event[k] & (counter != 2**COUNTER_BITS - 1)):
                m.d.sync += counter.eq(counter + 1)
            with m.If(self.restart):
                m.d.sync += counter.eq(0)
        return m

    def _examine(self, m: Module) -> None:
        """Works out what must be known about requests with a payload."""
        size = Signal(8 * SIZE.size)  # the payload's last bytes
        with m.If(self.payload_valid):
            m.d.sync += size.eq(Cat(size[8:], self.payload))
        self._size = width, height = size[:16], size[16:]
        config = self._config
        self._size_fits = Signal()
        self._is_size = Signal()
        self._is_line = Signal()
        line_bytes = Signal(16)
        each = pair_bytes(config.pixel)
        m.d.sync += [
            self._size_fits.eq(
                (width >= config.min_width)
                & (width <= config.max_width)
                & (height >= 1)
                & (height <= config.max_height)
            ),
            self._is_size.eq(self.length == SIZE.size),
            # Without a multiplier: a shifted width for each bit that is set in the number of a pair's bytes.
            line_bytes.eq(sum(self.width << bit for bit in range(each.bit_length()) if each >> bit & 1)),
            self._is_line.eq(self.length == line_bytes),
        ]

    def _carry_out(self, m: Module, old: Value) -> None:
        """Carries out the awaited request."""
        width, height = self._size
        with m.Switch(self.type):
            with m.Case(Type.BEGIN):
                with m.If(self.active | ~self._is_size):
                    self._refuse(m, Reason.ORDER)
                with m.Elif(~self._size_fits):
                    self._refuse(m, Reason.SIZE)
                with m.Else():
                    self._accept(m, old)
                    m.d.comb += self.begin.eq(1)
                    m.d.sync += [self.width.eq(width), self.height.eq(height), self._rows_left.eq(height)]
            with m.Case(Type.LINE):
                with m.If(~self.active | self.fed | ~self._is_line):
                    self._refuse(m, Reason.ORDER)
                with m.Elif(self.overrun | self.feeding):
                    m.d.comb += self._event[OVERRUNS].eq(1)
                    self._repeat(m, Repeat.BROKEN)
                with m.Else():
                    self._accept(m, old, with_line=True)
                    m.d.comb += self.feed.eq(1)
            with m.Case(Type.FETCH):
                self._accept(m, old, with_line=True)
            with m.Case(Type.STATUS):
                self._accept(m, old)
            with m.Default():
                self._refuse(m, Reason.TYPE)

    def _accept(self, m: Module, old: Value, with_line: bool = False) -> None:
        """The reply replaces one that is now confirmed; it carries a line if it may and one is ready."""
        reply = self.letter.reply
        m.d.comb += [self.post.eq(1), reply.type.eq(REPLY | self.type), self.release.eq(old.has_line)]
        m.d.sync += [self._awaited.eq(self.sequence + 1), old.eq(reply)]
        if with_line:
            with m.If(self.ready):
                m.d.comb += [
                    self.claim.eq(1),
                    reply.has_line.eq(1),
                    reply.slot.eq(self.slot),
                    reply.row.eq(self.height - self._rows_left),
                ]
                m.d.sync += self._rows_left.eq(self._rows_left - 1)

    def _refuse(self, m: Module, reason: Reason) -> None:
        m.d.comb += [
            self._refused.eq(1),
            self.post.eq(1),
            self.letter.reply.type.eq(REPLY | Type.ERROR),
            self.letter.note.eq(reason),
        ]

    def _repeat(self, m: Module, why: Repeat) -> None:
        m.d.comb += [
            self.post.eq(1),
            self.letter.reply.type.eq(REPLY | Type.REPEAT),
            self.letter.sequence.eq(self._awaited),
            self.letter.note.eq(why),
        ]
