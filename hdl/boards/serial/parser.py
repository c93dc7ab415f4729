"""Packets in: framing, header, payload and checksum."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.crc.catalog import CRC32_ETHERNET
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.serial.transmitter import BYTE_BITS
from softdepth.spec.protocol import CRC_BYTES, ESCAPE, FLAG, HEADER, TOGGLE

MAX_BODY = (1 << 16) - 1


class PacketParser(wiring.Component):
    """Finds packets, as `softdepth.spec.protocol` frames them, among bytes.

    A flag ends one packet and begins the next, so the first whole packet after any garbage is found.
    The payload is passed on as it comes, before the checksum is known: it may be stored, but not used
    until ``good``.

    Members
    -------
    valid, data, broken : a byte from the receiver; ``broken`` spoils its packet.
    version, type, sequence, length : the header; complete from the start of the payload until the next
        packet's first byte.
    payload_valid, payload, index : a byte of the payload, and its place in it.
    good, bad : a packet has ended, in this clock only. Two flags with nothing between them are no packet.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "valid": In(1),
                "data": In(BYTE_BITS),
                "broken": In(1),
                "version": Out(8),
                "type": Out(8),
                "sequence": Out(16),
                "length": Out(16),
                "payload_valid": Out(1),
                "payload": Out(8),
                "index": Out(16),
                "good": Out(1),
                "bad": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.crc = crc = CRC32_ETHERNET().create()
        count = Signal(range(MAX_BODY + 1))
        escaped = Signal()
        spoilt = Signal()
        byte = Signal(8)
        header = Signal(8 * HEADER.size)
        ended = count != 0
        # Bytes are at least a few clocks apart, so what is known of earlier ones may come a clock late.
        whole = Signal()
        m.d.sync += whole.eq(
            (count == self.length + (HEADER.size + CRC_BYTES)) & crc.match_detected & ~spoilt & ~escaped
        )
        m.d.comb += [
            byte.eq(Mux(escaped, self.data ^ TOGGLE, self.data)),
            crc.data.eq(byte),
            self.payload.eq(byte),
            self.version.eq(header[0:8]),
            self.type.eq(header[8:16]),
            self.sequence.eq(header[16:32]),
            self.length.eq(header[32:48]),
        ]
        with m.If(self.valid):
            with m.If(self.data == FLAG):
                m.d.comb += [crc.start.eq(1), self.good.eq(ended & whole), self.bad.eq(ended & ~whole)]
                m.d.sync += [count.eq(0), self.index.eq(0), escaped.eq(0), spoilt.eq(self.broken)]
            with m.Elif(self.data == ESCAPE):
                m.d.sync += [escaped.eq(1), spoilt.eq(spoilt | self.broken | escaped)]
            with m.Else():
                m.d.comb += crc.valid.eq(1)
                m.d.sync += [escaped.eq(0), spoilt.eq(spoilt | self.broken)]
                with m.If(count == MAX_BODY):
                    m.d.sync += spoilt.eq(1)
                with m.Else():
                    m.d.sync += count.eq(count + 1)
                for place in range(HEADER.size):
                    with m.If(count == place):
                        m.d.sync += header.word_select(place, 8).eq(byte)
                with m.If(count >= HEADER.size):
                    m.d.comb += self.payload_valid.eq(self.index != self.length)
                    with m.If(self.index != self.length):
                        m.d.sync += self.index.eq(self.index + 1)
        return m
