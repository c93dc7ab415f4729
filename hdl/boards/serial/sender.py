"""Packets out: header, payload, checksum and framing."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, unsigned
from amaranth.lib import stream, wiring
from amaranth.lib.crc.catalog import CRC32_ETHERNET
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.serial.transmitter import BYTE_BITS
from softdepth.spec.protocol import CRC_BYTES, ESCAPE, FLAG, HEADER, TOGGLE, VERSION


class PacketSender(wiring.Component):
    """Sends a packet, as `softdepth.spec.protocol` frames it, byte by byte.

    Members
    -------
    start : begin a packet; ``type``, ``sequence`` and ``length`` must hold from now until `busy` falls.
    busy : a packet is under way.
    index, data : which byte of the payload comes next, and that byte. It is taken when the one before has
        been sent, so it may follow its index by as many clocks as a byte takes.
    o : stream of bytes for the line.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "start": In(1),
                "type": In(8),
                "sequence": In(16),
                "length": In(16),
                "busy": Out(1),
                "index": Out(16),
                "data": In(8),
                "o": Out(stream.Signature(BYTE_BITS)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.crc = crc = CRC32_ETHERNET().create()
        place = Signal(range(HEADER.size))  # in the header, or in the checksum
        escaped = Signal()
        byte = Signal(unsigned(BYTE_BITS))
        m.d.comb += self.busy.eq(1)
        m.d.sync += [crc.data.eq(byte), crc.valid.eq(0)]

        header = Signal(8 * HEADER.size)
        m.d.comb += header.eq(Cat(Const(VERSION, 8), self.type, self.sequence, self.length))

        special = (byte == FLAG) | (byte == ESCAPE)
        begin_escape = special & ~escaped
        taken = self.o.valid & self.o.ready
        passed = Signal()  # the byte itself goes out, not the escape before it

        def body(checked: bool) -> None:
            m.d.comb += [
                self.o.valid.eq(1),
                self.o.payload.eq(Mux(begin_escape, ESCAPE, Mux(escaped, byte ^ TOGGLE, byte))),
                passed.eq(taken & ~begin_escape),
            ]
            if checked:
                m.d.sync += crc.valid.eq(passed)
            with m.If(taken):
                m.d.sync += escaped.eq(begin_escape)

        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += [crc.start.eq(1), self.busy.eq(0)]
                m.d.sync += [self.index.eq(0), place.eq(0), escaped.eq(0)]
                with m.If(self.start):
                    m.next = "OPEN"
            with m.State("OPEN"):
                m.d.comb += [self.o.valid.eq(1), self.o.payload.eq(FLAG)]
                with m.If(taken):
                    m.next = "HEADER"
            with m.State("HEADER"):
                m.d.comb += byte.eq(header.word_select(place, 8))
                body(checked=True)
                with m.If(passed):
                    m.d.sync += place.eq(place + 1)
                    with m.If(place == HEADER.size - 1):
                        m.d.sync += place.eq(0)
                        m.next = "PAYLOAD"
            with m.State("PAYLOAD"):
                with m.If(self.index == self.length):
                    m.next = "CHECKSUM"
                with m.Else():
                    m.d.comb += byte.eq(self.data)
                    body(checked=True)
                    with m.If(passed):
                        m.d.sync += self.index.eq(self.index + 1)
            with m.State("CHECKSUM"):
                m.d.comb += byte.eq(crc.crc.word_select(place[: (CRC_BYTES - 1).bit_length()], 8))
                body(checked=False)
                with m.If(passed):
                    m.d.sync += place.eq(place + 1)
                    with m.If(place == CRC_BYTES - 1):
                        m.next = "CLOSE"
            with m.State("CLOSE"):
                m.d.comb += [self.o.valid.eq(1), self.o.payload.eq(FLAG)]
                with m.If(taken):
                    m.next = "IDLE"
        return m
