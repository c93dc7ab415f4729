"""A board in plain Python at the end of a pseudo-terminal, which can misbehave."""

import contextlib
import os
import select
import threading
import tty
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from softdepth.golden import fixed_model
from softdepth.golden.front.views import to_core_view
from softdepth.hdl.costs.comparison import by_windows
from softdepth.spec.config import Config
from softdepth.spec.protocol import (
    COUNTERS,
    FLAG,
    REPLY,
    ROW,
    SIZE,
    WINDOW,
    Packet,
    Reason,
    Repeat,
    Type,
    decode,
    describe,
    encode,
    result_bytes,
)

POLL_SECONDS = 0.02


@dataclass
class Misdeeds:
    """What the board does wrong.

    Members
    -------
    silent_after : requests after which it says nothing more.
    lose_replies, garble_replies : the numbers of replies that are lost, or arrive broken.
    refuse : the reason that it gives for refusing lines.
    version : of its replies.
    hello : its description, in place of the true one.
    core_counters : what the core counted.
    swap_rows : it gives lines of results out of order.
    never_ready : it never has a line of results.
    dies_after : requests after which the port goes away.
    """

    silent_after: int | None = None
    lose_replies: frozenset[int] = frozenset()
    garble_replies: frozenset[int] = frozenset()
    refuse: Reason | None = None
    version: int = 1
    hello: bytes | None = None
    core_counters: tuple[int, int, int, int] = (0, 0, 0, 0)
    swap_rows: bool = False
    never_ready: bool = False
    dies_after: int | None = None


@dataclass
class FakeBoard:
    """Answers as the gateware does; its results are the fixed model's.

    Members
    -------
    path : its serial port.
    lines : how often each line of the frame was carried out.
    """

    config: Config
    misdeeds: Misdeeds = field(default_factory=Misdeeds)
    path: str = ""
    lines: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        self.path = os.ttyname(self.slave)
        self.stopped = threading.Event()
        self.awaited: int | None = None
        self.kept: dict[int, bytes] = {}
        self.size = (0, 0)
        self.given = 0
        self.requests = 0
        self.replies = 0

    def serve(self) -> None:
        """Answer until stopped, then close the port."""
        rest = b""
        while not self.stopped.is_set():
            if not select.select([self.master], [], [], POLL_SECONDS)[0]:
                continue
            *framed, rest = (rest + os.read(self.master, 4096)).split(bytes([FLAG]))
            for part in filter(None, framed):
                if not self.stopped.is_set():
                    self._handle(decode(part))
        os.close(self.master)
        os.close(self.slave)

    def _handle(self, packet: Packet | None) -> None:
        self.requests += 1
        misdeeds = self.misdeeds
        if misdeeds.dies_after is not None and self.requests > misdeeds.dies_after:
            self.stopped.set()
            return
        if misdeeds.silent_after is not None and self.requests > misdeeds.silent_after:
            return
        if packet is None:
            if self.awaited is not None:
                self._reply(Packet(REPLY | Type.REPEAT, self.awaited, bytes([Repeat.BROKEN])))
        elif packet.type == Type.HELLO:
            self.awaited = packet.sequence
            self._carry_out(packet)
        elif self.awaited is None:
            self._reply(Packet(REPLY | Type.ERROR, packet.sequence, bytes([Reason.SESSION])))
        elif packet.sequence == self.awaited:
            self._carry_out(packet)
        elif (self.awaited - packet.sequence) % 65536 <= WINDOW:
            self._send(self.kept[packet.sequence])
        else:
            self._reply(Packet(REPLY | Type.REPEAT, self.awaited, bytes([Repeat.GAP])))

    def _carry_out(self, packet: Packet) -> None:
        payload = b""
        match packet.type:
            case Type.HELLO:
                payload = self.misdeeds.hello or describe(self.config, "ulx3s-85f", "fake")
            case Type.BEGIN:
                self.size, self.lines, self.given = SIZE.unpack(packet.payload), [], 0
            case Type.LINE:
                if self.misdeeds.refuse is not None:
                    self._reply(Packet(REPLY | Type.ERROR, packet.sequence, bytes([self.misdeeds.refuse])))
                    return
                self.lines.append(packet.payload)
                payload = self._line()
            case Type.FETCH:
                payload = self._line()
            case Type.STATUS:
                payload = COUNTERS.pack(self.requests, 0, 0, 0, *self.misdeeds.core_counters)
        self.awaited = (packet.sequence + 1) % 65536
        reply = Packet(REPLY | packet.type, packet.sequence, payload, self.misdeeds.version)
        self.kept[packet.sequence] = encode(reply)
        self._send(self.kept[packet.sequence])

    def _line(self) -> bytes:
        """The next line of results, if the pixels of its support are there."""
        width, height = self.size
        below = self.config.reach_rows if by_windows(self.config) else height
        behind = 0 if len(self.lines) == height else below
        if self.given + behind >= len(self.lines) or self.misdeeds.never_ready:
            return b""
        row = self.given
        self.given += 1
        # The model needs the whole frame; what is not there yet is not in this line's support.
        pixels = np.zeros((height, width, 6), np.uint8)
        pixels[: len(self.lines)] = np.frombuffer(b"".join(self.lines), np.uint8).reshape(-1, width, 6)
        left, right = to_core_view(pixels[..., :3], pixels[..., 3:], self.config)
        found = fixed_model.disparity(left, right, self.config)
        found = found.mirrored() if self.config.reference == "right" else found
        config = self.config
        words = found.disparity[row] | found.code[row].astype(np.uint32) << config.result_bits
        if found.confidence is not None:
            words |= found.confidence[row].astype(np.uint32) << (config.result_bits + config.code_bits)
        number = row ^ 1 if self.misdeeds.swap_rows else row
        return ROW.pack(number) + words.astype(f"<u{result_bytes(self.config)}").tobytes()

    def _reply(self, packet: Packet) -> None:
        self._send(encode(packet._replace(version=self.misdeeds.version)))

    def _send(self, framed: bytes) -> None:
        number, self.replies = self.replies, self.replies + 1
        if number in self.misdeeds.lose_replies:
            return
        if number in self.misdeeds.garble_replies:
            framed = framed[:5] + bytes([framed[5] ^ 0x10]) + framed[6:]
        os.write(self.master, framed)


@contextlib.contextmanager
def plugged_in(config: Config, misdeeds: Misdeeds | None = None) -> Iterator[FakeBoard]:
    """A fake board that serves meanwhile."""
    board = FakeBoard(config, misdeeds or Misdeeds())
    server = threading.Thread(target=board.serve, daemon=True)
    server.start()
    try:
        yield board
    finally:
        board.stopped.set()
        server.join()  # the numbers of its files may be another board's from now on
