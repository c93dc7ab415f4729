"""The core behind a serial line."""

from amaranth.hdl import Cat, Module, Mux, ResetInserter, Value
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.line_store import LineStore
from softdepth.hdl.boards.outbox import Outbox
from softdepth.hdl.boards.result_store import ResultStore
from softdepth.hdl.boards.serial.parser import PacketParser
from softdepth.hdl.boards.serial.receiver import UartReceiver
from softdepth.hdl.boards.serial.sender import PacketSender
from softdepth.hdl.boards.serial.transmitter import UartTransmitter
from softdepth.hdl.boards.session import Session
from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config
from softdepth.spec.protocol import COUNTERS, REPLY, ROW, Type, check_lines


class SerialCore(wiring.Component):
    """A stereo core that speaks `softdepth.spec.protocol` on a serial line.

    ::

        rx > receiver > parser > line store > core > result store > sender > transmitter > tx
                          > session > outbox (what to answer)       >

    Parameters
    ----------
    config : of the core.
    divisor : clocks per bit of the line.
    hello : what the board says about itself (`softdepth.spec.protocol.describe`), kept in a ROM.

    Members
    -------
    rx, tx : the line.
    receiving, troubled : a packet came; something was wrong with it. In this clock only.
    active : a frame is under way.
    fault : the core broke its own rules.

    Raises `ConfigError` if the longest line does not fit into a packet.
    """

    def __init__(self, config: Config, divisor: int, hello: bytes) -> None:
        check_lines(config)
        self._config = config
        self._divisor = divisor
        self._hello = hello
        super().__init__(
            {
                "rx": In(1, init=1),
                "tx": Out(1, init=1),
                "receiving": Out(1),
                "troubled": Out(1),
                "active": Out(1),
                "fault": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        m.submodules.receiver = receiver = UartReceiver(self._divisor)
        m.submodules.parser = parser = PacketParser()
        m.submodules.session = session = Session(config)
        lengths = {Type.HELLO: len(self._hello), Type.STATUS: COUNTERS.size, Type.REPEAT: 1, Type.ERROR: 1}
        m.submodules.outbox = outbox = Outbox(config, lengths)
        m.submodules.sender = sender = PacketSender()
        m.submodules.transmitter = transmitter = UartTransmitter(self._divisor)

        # A session begins with everything behind the link as it is after power-up.
        fresh = ResetInserter(session.restart)
        lines, core, results = LineStore(config), StereoCore(config), ResultStore(config)
        m.submodules.lines = fresh(lines)
        m.submodules.core = fresh(core)
        m.submodules.results = fresh(results)

        wiring.connect(m, lines.o, core.i)
        wiring.connect(m, core.o, results.i)
        wiring.connect(m, sender.o, transmitter.i)
        m.d.comb += [
            receiver.rx.eq(self.rx),
            self.tx.eq(transmitter.tx),
            *[getattr(parser, name).eq(getattr(receiver, name)) for name in ("valid", "data", "broken")],
            *[
                getattr(session, name).eq(getattr(parser, name))
                for name in (
                    "good",
                    "bad",
                    "version",
                    "type",
                    "sequence",
                    "length",
                    "payload_valid",
                    "payload",
                )
            ],
            lines.width.eq(session.width),
            lines.height.eq(session.height),
            lines.begin.eq(session.begin),
            lines.close.eq(session.receiving),
            lines.valid.eq(parser.payload_valid),
            lines.data.eq(parser.payload),
            lines.feed.eq(session.feed),
            session.feeding.eq(lines.busy),
            session.fed.eq(lines.complete),
            session.overrun.eq(lines.overrun),
            results.width.eq(session.width),
            results.claim.eq(session.claim),
            results.release.eq(session.release),
            session.ready.eq(results.ready),
            session.slot.eq(results.slot),
            session.fault.eq(results.fault),
            outbox.post.eq(session.post),
            outbox.i.eq(session.letter),
            outbox.width.eq(session.width),
            outbox.sending.eq(sender.busy),
            session.full.eq(outbox.full),
            sender.start.eq(outbox.start),
            sender.type.eq(outbox.o.reply.type),
            sender.sequence.eq(outbox.o.sequence),
            sender.length.eq(outbox.length),
            self.receiving.eq(session.receiving),
            self.troubled.eq(session.troubled),
            self.active.eq(session.active),
            self.fault.eq(results.fault),
        ]
        counters = Cat(session.counters, core.status)
        self._payload(m, outbox, sender, results, counters)
        return m

    def _payload(
        self, m: Module, outbox: Outbox, sender: PacketSender, results: ResultStore, counters: Value
    ) -> None:
        """Gives the sender the payload's byte that it is at. A byte takes long enough to read a memory."""
        m.submodules.hello = hello = Memory(shape=8, depth=len(self._hello), init=list(self._hello))
        text = hello.read_port()
        m.d.comb += [
            text.addr.eq(sender.index),
            results.read_slot.eq(outbox.o.reply.slot),
            results.index.eq(sender.index - ROW.size),
        ]
        row = outbox.o.reply.row.word_select(sender.index[0], 8)
        with m.Switch(outbox.o.reply.type):
            with m.Case(REPLY | Type.HELLO):
                m.d.sync += sender.data.eq(text.data)
            with m.Case(REPLY | Type.LINE, REPLY | Type.FETCH):
                m.d.sync += sender.data.eq(Mux(sender.index < ROW.size, row, results.data))
            with m.Case(REPLY | Type.STATUS):
                # The host waits for this reply, so the counters stand still.
                place = sender.index[: (COUNTERS.size - 1).bit_length()]
                m.d.sync += sender.data.eq(counters.word_select(place, 8))
            with m.Default():
                m.d.sync += sender.data.eq(outbox.o.note)
