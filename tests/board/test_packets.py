"""Packet sender and parser against the host's encoding."""

import struct
import zlib

import numpy as np
import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.boards.serial.parser import PacketParser
from softdepth.hdl.boards.serial.sender import PacketSender
from softdepth.spec.protocol import ESCAPE, FLAG, Packet, Type, decode, encode
from tests.support.simulation import simulate

SPECIAL = bytes([FLAG, ESCAPE, 0, 0x5E, 0x5D, FLAG, FLAG])


def sent(packet: Packet) -> bytes:
    """The bytes that the sender gives, to a line that is slow at times."""
    dut = PacketSender()
    out = bytearray()
    random = np.random.default_rng(3)

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        ctx.set(dut.type, packet.type)
        ctx.set(dut.sequence, packet.sequence)
        ctx.set(dut.length, len(packet.payload))
        ctx.set(dut.start, 1)
        await ctx.tick()
        ctx.set(dut.start, 0)
        while ctx.get(dut.busy):
            index = ctx.get(dut.index)
            ctx.set(dut.data, packet.payload[index] if index < len(packet.payload) else 0)
            ctx.set(dut.o.ready, int(random.integers(2)))
            _, _, valid, ready, byte = await ctx.tick().sample(dut.o.valid, dut.o.ready, dut.o.payload)
            if valid and ready:
                out.append(byte)

    simulate(dut, bench)
    return bytes(out)


def parsed(data: bytes, broken: int | None = None) -> list[Packet | None]:
    """The packets among bytes; the byte of index `broken` has no stop bit."""
    dut = PacketParser()
    found: list[Packet | None] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        payload = bytearray()
        for place, byte in enumerate(data):
            ctx.set(dut.valid, 1)
            ctx.set(dut.data, byte)
            ctx.set(dut.broken, place == broken)
            await ctx.delay(0)
            if ctx.get(dut.payload_valid):
                assert ctx.get(dut.index) == len(payload)
                payload.append(ctx.get(dut.payload))
            good, bad = ctx.get(dut.good), ctx.get(dut.bad)
            if good:
                kind, sequence, version = (ctx.get(p) for p in (dut.type, dut.sequence, dut.version))
                assert ctx.get(dut.length) == len(payload)
                found.append(Packet(kind, sequence, bytes(payload), version))
            if bad:
                found.append(None)
            if good or bad:
                payload.clear()
            await ctx.tick()
            ctx.set(dut.valid, 0)
            await ctx.tick().repeat(2)

    simulate(dut, bench)
    return found


@pytest.mark.parametrize("payload", [b"", b"\x01", SPECIAL, bytes(range(256)) + SPECIAL])
def test_sender_writes_what_the_host_reads(payload):
    packet = Packet(0x80 | Type.LINE, 0x7E7D, payload)
    assert sent(packet) == encode(packet)


def test_parser_reads_what_the_host_writes():
    packets = [Packet(Type.HELLO, 1), Packet(Type.LINE, 0x7E7D, SPECIAL), Packet(9, 3, b"xyz", version=77)]
    assert parsed(b"".join(map(encode, packets))) == packets


def test_parser_finds_the_next_packet_after_garbage():
    whole = encode(Packet(Type.LINE, 5, b"abcdef"))
    garbage = b"\x00\x7d\x7d" + whole[3:9] + bytes([ESCAPE])
    assert parsed(garbage + whole) == [None, Packet(Type.LINE, 5, b"abcdef")]
    # a packet that lost its end is two: the rest of it, and the next
    assert parsed(whole[:-4] + whole) == [None, Packet(Type.LINE, 5, b"abcdef")]


def test_parser_agrees_with_the_host_on_every_flipped_bit():
    whole = encode(Packet(Type.LINE, 0x1234, bytes([FLAG, 0x55, ESCAPE])))
    for place in range(1, len(whole) - 1):
        wrong = bytearray(whole)
        wrong[place] ^= 1 << (place % 8)
        parts = [part for part in bytes(wrong).split(bytes([FLAG])) if part]
        assert [decode(part) for part in parts] == [None] * len(parts)
        found = parsed(bytes(wrong) + whole)
        assert found[-1] == decode(whole[1:-1])
        assert set(found[:-1]) == {None}


def test_a_byte_without_stop_bit_spoils_its_packet_only():
    whole = encode(Packet(Type.STATUS, 8, b"1234"))
    assert parsed(whole + whole, broken=7) == [None, Packet(Type.STATUS, 8, b"1234")]


def test_a_length_that_is_not_the_payloads_is_bad():
    for length in (0, 3, 5, 400):
        body = struct.pack("<BBHH", 1, Type.LINE, 2, length) + b"wxyz"
        body += zlib.crc32(body).to_bytes(4, "little")
        assert not {FLAG, ESCAPE} & set(body)
        assert parsed(bytes([FLAG]) + body + bytes([FLAG])) == [None]
