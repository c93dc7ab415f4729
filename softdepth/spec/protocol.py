"""The language of the serial link between a host and a board: the one source of its constants.

A packet is framed as in RFC 1662 (PPP in HDLC-like framing): a flag, the body, a flag. Inside the
body a flag or an escape is sent as `ESCAPE` and the byte with `TOGGLE` flipped, so that a flag always
begins anew, whatever was lost before it. A body is::

    version u8 | type u8 | sequence u16 | length u16 | payload | CRC-32 u32       (little endian)

The CRC is Ethernet's (``zlib.crc32``), over everything before it. The host asks, the board answers:
each request has exactly one reply, of the request's type and sequence number plus `REPLY`. See
``docs/boards.md`` for the conversation.
"""

import json
import struct
import zlib
from enum import IntEnum
from typing import Any, NamedTuple

from softdepth.spec.config import CONFIDENCE_BITS, Config, PixelFormat
from softdepth.spec.errors import ConfigError

VERSION = 1
FLAG = 0x7E
ESCAPE = 0x7D
TOGGLE = 0x20

HEADER = struct.Struct("<BBHH")
CRC_BYTES = 4
LONGEST = (1 << 16) - 1
"""Bytes of the longest payload: its length is a u16."""
SEQUENCES = 1 << 16
WINDOW = 2
"""Requests that may be under way: the board keeps as many replies, to send them again."""

REPLY = 0x80
SIZE = struct.Struct("<HH")
ROW = struct.Struct("<H")


class Type(IntEnum):
    """What a packet is for; a reply has `REPLY` added."""

    HELLO = 1
    """Begin a session: the core is reset, the reply describes it (`describe`)."""
    BEGIN = 2
    """Begin a frame of the size in the payload (`SIZE`: width, height)."""
    LINE = 3
    """The frame's next line of pixel pairs. The reply holds a line of results, or nothing yet."""
    FETCH = 4
    """Ask for a line of results, when there is no line to send. The reply is `LINE`'s."""
    STATUS = 5
    """Ask for the counters (`Counters`)."""
    REPEAT = 6
    """Reply only: a packet was lost or broken. Its sequence number is the one that the board awaits."""
    ERROR = 7
    """Reply only: the request cannot be done, for the reason in the payload (`Reason`)."""


class Repeat(IntEnum):
    """Why a packet has to be sent again."""

    BROKEN = 1
    """Its checksum, its length or a stop bit was wrong."""
    GAP = 2
    """It came out of turn, so that one before it was lost."""


class Reason(IntEnum):
    """Why a request cannot be done."""

    VERSION = 1
    TYPE = 2
    SESSION = 3
    SIZE = 4
    ORDER = 5
    CORE = 6


class Packet(NamedTuple):
    """A packet without its frame."""

    type: int
    sequence: int
    payload: bytes = b""
    version: int = VERSION


class Counters(NamedTuple):
    """The board's counters since the session began, each u16 and saturating.

    The first four are the link's; the others are the core's (`softdepth.hdl.signatures.Status`).
    """

    packets: int
    broken: int
    gaps: int
    overruns: int
    short_lines: int
    long_lines: int
    early_starts: int
    missing_starts: int

    @property
    def core(self) -> tuple[int, ...]:
        """The core's own counters, in their order."""
        return self[4:]


COUNTERS = struct.Struct("<8H")


def encode(packet: Packet) -> bytes:
    """A packet as it goes over the wire, flags included."""
    body = HEADER.pack(packet.version, packet.type, packet.sequence, len(packet.payload)) + packet.payload
    body += zlib.crc32(body).to_bytes(CRC_BYTES, "little")
    # the escape first: what the flag becomes contains one
    for byte in (ESCAPE, FLAG):
        body = body.replace(bytes([byte]), bytes([ESCAPE, byte ^ TOGGLE]))
    return bytes([FLAG]) + body + bytes([FLAG])


def decode(framed: bytes) -> Packet | None:
    """What stood between two flags, or None where checksum, length or escapes are wrong."""
    first, *escaped = framed.split(bytes([ESCAPE]))
    if not all(escaped):
        return None
    body = first + b"".join(bytes([part[0] ^ TOGGLE]) + part[1:] for part in escaped)
    if len(body) < HEADER.size + CRC_BYTES:
        return None
    content, crc = body[:-CRC_BYTES], body[-CRC_BYTES:]
    if zlib.crc32(content) != int.from_bytes(crc, "little"):
        return None
    version, kind, sequence, length = HEADER.unpack_from(content)
    if len(content) != HEADER.size + length:
        return None
    return Packet(kind, sequence, content[HEADER.size :], version)


def pair_bytes(pixel: PixelFormat) -> int:
    """Bytes of a pixel pair in a line: left red, green, blue, or gray, then right; each little endian."""
    return 2 * pixel.bytes


def check_lines(config: Config) -> None:
    """Raise `ConfigError` if a line of the largest image does not fit into a packet."""
    most = LONGEST // pair_bytes(config.pixel)
    if config.max_width > most:
        raise ConfigError(
            f"max_width = {config.max_width}: a line of {config.pixel.value} pairs is longer than"
            f" the {LONGEST} bytes of a packet",
            f"use a max_width of at most {most}, or fewer bits a pixel",
        )


def result_bytes(config: Config) -> int:
    """Bytes of a result on the wire, little endian: disparity, code above it, confidence above both.

    They are a power of two: a byte's place tells its result by its upper bits.
    """
    confidence = CONFIDENCE_BITS if config.post.confidence else 0
    needed = -(-(config.result_bits + config.code_bits + confidence) // 8)
    return 1 << (needed - 1).bit_length()


def describe(config: Config, board: str, revision: str) -> bytes:
    """What a board says of itself in reply to `Type.HELLO`: JSON, UTF-8.

    It holds what the configuration changes in the defaults; the hash tells whether both ends have the
    same defaults.
    """
    changed = config.model_dump(mode="json", exclude_defaults=True)
    for said_of, criterion in zip(changed.get("criteria", ()), config.criteria, strict=False):
        said_of["kind"] = criterion.kind  # each kind's own default, but not theirs together
    said: dict[str, Any] = {
        "board": board,
        "revision": revision,
        "hash": config.hash,
        "config": changed,
    }
    return json.dumps(said, separators=(",", ":")).encode()
