"""Requests to a board and its replies, whatever the line does to them."""

import os
import time
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NoReturn

from softdepth.board.port import Port
from softdepth.spec.errors import ToolError
from softdepth.spec.protocol import (
    FLAG,
    REPLY,
    SEQUENCES,
    VERSION,
    WINDOW,
    Packet,
    Reason,
    Repeat,
    Type,
    decode,
    encode,
)

TRIES = 10
"""How often a packet is sent without an answer before the link is given up."""

LONGEST = 1 << 18
"""Bytes without a flag after which what came is garbage."""

Request = tuple[Type, bytes]

REBUILD = "build the bitstream with this version: make bitstream"

_REFUSALS = {
    Reason.VERSION: (f"the board does not speak version {VERSION} of the protocol", REBUILD),
    Reason.TYPE: ("the board does not know a request of this version", REBUILD),
    Reason.SESSION: ("the board was reset in the middle of its work", "repeat the command"),
    Reason.SIZE: ("the board's core cannot take images of this size", "give smaller images"),
    Reason.ORDER: ("the board and this program disagree about the frame", "repeat the command"),
    Reason.CORE: (
        "the core on the board broke its own rules",
        "repeat the command; if it happens again, the bitstream's timing or the board is not sound",
    ),
}


@dataclass
class LinkCounters:
    """What the host saw on the line.

    Members
    -------
    sent : packets, those sent again included.
    repeated : packets sent again.
    timeouts : times that an answer did not come.
    broken : packets that came with a wrong checksum or length.
    """

    sent: int = 0
    repeated: int = 0
    timeouts: int = 0
    broken: int = 0


class Link:
    """A conversation with a board: up to `WINDOW` requests under way, each answered exactly once.

    Parameters
    ----------
    port : an open port.
    timeout : seconds without a needed answer after which requests are sent again, beside the time that
        the line itself takes.
    """

    def __init__(self, port: Port, timeout: float = 0.5) -> None:
        self.counters = LinkCounters()
        self._port = port
        self._timeout = timeout
        self._sequence = int.from_bytes(os.urandom(2), "little")
        self._rest = b""
        self._heard = False

    def hello(self) -> bytes:
        """Begin a session: the board's description of itself."""
        self._port.drain()
        self._rest = b""
        return next(self.ask([(Type.HELLO, b"")]))

    def ask(self, requests: Iterable[Request]) -> Iterator[bytes]:
        """The payload of each request's reply, in order. The next requests are under way meanwhile.

        Raises `ToolError` if the board refuses, goes silent, or the line is too noisy.
        """
        source = iter(requests)
        waiting: deque[Packet] = deque()
        replies: dict[int, bytes] = {}
        while True:
            while len(waiting) < WINDOW and (request := next(source, None)):
                packet = Packet(request[0], self._sequence, request[1])
                self._sequence = (self._sequence + 1) % SEQUENCES
                waiting.append(packet)
                self._send([packet])
            if not waiting:
                return
            self._await(waiting, replies)
            while waiting and waiting[0].sequence in replies:
                yield replies.pop(waiting.popleft().sequence)

    def _await(self, waiting: deque[Packet], replies: dict[int, bytes]) -> None:
        """Read, and send again where need be, until the oldest request is answered."""
        oldest = waiting[0].sequence
        tries = 1
        gap_seen = False
        deadline = self._deadline(waiting)
        while oldest not in replies:
            again = False
            found = self._packets(deadline)
            if not found:
                self.counters.timeouts += 1
                again = True
            for packet in found:
                if packet is None:
                    self.counters.broken += 1
                    again = True
                    continue
                self._heard = True
                match = next((w for w in waiting if w.sequence == packet.sequence), None)
                if packet.type == REPLY | Type.ERROR and (match or packet.version != VERSION):
                    self._refused(packet)
                elif packet.type == REPLY | Type.REPEAT and match:
                    # Those that follow a lost packet are all out of turn: one repetition cures them.
                    gap = packet.payload == bytes([Repeat.GAP])
                    again |= not (gap and gap_seen)
                    gap_seen |= gap
                elif match and packet.type == REPLY | match.type:
                    replies[packet.sequence] = packet.payload
            # Also when the oldest came beside a broken one: nobody would ask for that until it is the oldest.
            missing = [packet for packet in waiting if packet.sequence not in replies]
            if again and missing:
                if oldest not in replies and tries == TRIES:
                    self._give_up()
                tries += 1
                self.counters.repeated += len(missing)
                self._send(missing)
                deadline = self._deadline(waiting)

    def _send(self, packets: Iterable[Packet]) -> None:
        for packet in packets:
            self.counters.sent += 1
            self._port.write(encode(packet))

    def _deadline(self, waiting: Iterable[Packet]) -> float:
        """When the answer should be here: twice the line's time for it all, and the timeout."""
        bits = 10 * sum(2 * len(packet.payload) + 1024 for packet in waiting)
        return time.monotonic() + 2 * bits / self._port.baud + self._timeout

    def _packets(self, deadline: float) -> list[Packet | None]:
        """What came between flags, None for what is broken; nothing when the deadline passes."""
        while (left := deadline - time.monotonic()) > 0:
            *framed, self._rest = (self._rest + self._port.read(left)).split(bytes([FLAG]))
            if len(self._rest) > LONGEST:
                self._rest = b""
            if found := [decode(part) for part in framed if part]:
                return found
        return []

    def _refused(self, packet: Packet) -> NoReturn:
        if packet.version != VERSION:
            problem = f"the board speaks version {packet.version} of the protocol, this program {VERSION}"
            raise ToolError(problem, REBUILD)
        reason = packet.payload[0] if packet.payload else 0
        known = {int(each): text for each, text in _REFUSALS.items()}
        raise ToolError(*known.get(reason, (f"the board refused, for reason {reason}", REBUILD)))

    def _give_up(self) -> NoReturn:
        if not self._heard:
            raise ToolError(
                f"no board answers on '{self._port.path}' at {self._port.baud} baud",
                "load the bitstream (make program), check --port, and --board or --baud",
            )
        raise ToolError(
            f"the link on '{self._port.path}' is too bad: {TRIES} tries of a packet failed,"
            f" {self.counters.broken} answers were broken",
            "use another cable or USB port, or check whether the board is still running",
        )
