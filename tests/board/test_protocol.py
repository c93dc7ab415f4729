"""The protocol's packets, as the host writes and reads them."""

import json
import zlib

import numpy as np
import pytest

from softdepth.spec.config import CONFIDENCE_BITS, Config
from softdepth.spec.errors import ConfigError
from softdepth.spec.presets import PRESETS
from softdepth.spec.protocol import (
    ESCAPE,
    FLAG,
    LONGEST,
    ROW,
    Packet,
    Type,
    check_lines,
    decode,
    describe,
    encode,
    pair_bytes,
    result_bytes,
)


def inside(framed: bytes) -> bytes:
    assert framed[0] == framed[-1] == FLAG
    assert FLAG not in framed[1:-1]
    return framed[1:-1]


@pytest.mark.parametrize("length", [0, 1, 255, 256, 7680])
def test_packets_survive(length):
    payload = np.random.default_rng(length).bytes(length)
    packet = Packet(Type.LINE, 0x7D7E, payload)
    assert decode(inside(encode(packet))) == packet


def test_the_wire_is_as_documented():
    body = bytes([1, 3, 0x34, 0x12, 2, 0, FLAG, ESCAPE])
    crc = zlib.crc32(body).to_bytes(4, "little")
    expected = bytes([FLAG, 1, 3, 0x34, 0x12, 2, 0, 0x7D, 0x5E, 0x7D, 0x5D]) + crc + bytes([FLAG])
    assert encode(Packet(Type.LINE, 0x1234, bytes([FLAG, ESCAPE]))) == expected


def test_every_flipped_bit_is_found():
    whole = inside(encode(Packet(Type.LINE, 7, bytes(range(0x70, 0x90)))))
    for place in range(len(whole)):
        for bit in range(8):
            wrong = bytearray(whole)
            wrong[place] ^= 1 << bit
            assert all(decode(part) is None for part in bytes(wrong).split(bytes([FLAG]))), (place, bit)


def test_every_cut_and_every_lost_byte_is_found():
    whole = inside(encode(Packet(Type.STATUS, 500, bytes(range(0x78, 0x88)))))
    for place in range(len(whole)):
        assert decode(whole[:place]) is None
        assert decode(whole[:place] + whole[place + 1 :]) is None


def test_an_escape_at_the_end_is_broken():
    assert decode(bytes([ESCAPE])) is None
    assert decode(inside(encode(Packet(Type.HELLO, 0))) + bytes([ESCAPE])) is None
    assert decode(bytes([ESCAPE, ESCAPE, 0])) is None


@pytest.mark.parametrize(("disparities", "size"), [(8, 1), (64, 1), (65, 2), (256, 2)])
def test_results_take_whole_bytes(disparities, size):
    assert result_bytes(Config.from_dict({"disparities": disparities, "lanes": 1})) == size


def test_a_result_with_a_confidence_takes_four_bytes():
    config = Config.preset("robust")
    assert 16 < config.result_bits + config.code_bits + CONFIDENCE_BITS <= 24
    assert result_bytes(config) == 4


@pytest.mark.parametrize("preset", PRESETS)
def test_a_board_describes_its_configuration(preset):
    config = Config.preset(preset).override(["lanes=4"])
    said = json.loads(describe(config, "ulx3s-12f", "0.1.0"))
    assert (said["board"], said["revision"], said["hash"]) == ("ulx3s-12f", "0.1.0", config.hash)
    assert Config.from_dict(said["config"]) == config


@pytest.mark.parametrize("pixel", ["rgb12", "rgb10"])
def test_a_line_that_no_packet_holds_is_refused(pixel):
    """The longest line that is taken can be sent, and one pair more cannot."""
    config = Config.preset("sad").override([f"pixel={pixel}", "max_width=5461"])
    check_lines(config)
    payload = bytes(5461 * pair_bytes(config.pixel))
    assert decode(inside(encode(Packet(Type.LINE, 0, payload)))) is not None
    assert len(payload) + pair_bytes(config.pixel) > LONGEST
    with pytest.raises(ConfigError, match=r"max_width = 5462: .*; use a max_width of at most 5461"):
        check_lines(config.override(["max_width=5462"]))


def test_every_other_line_fits_however_long():
    config = Config.preset("robust").override(["pixel=gray12", "max_width=8192"])
    check_lines(config)
    assert 8192 * result_bytes(config) + ROW.size <= LONGEST
