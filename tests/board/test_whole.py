"""The board's top, simulated at its serial pins, and the real host command at the other end of a port."""

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from softdepth.board.device import Device
from softdepth.board.link import Link
from softdepth.board.port import Port
from softdepth.golden import fixed_model
from softdepth.spec.boards import BOARDS
from softdepth.spec.config import Config
from softdepth.spec.protocol import FLAG, REPLY, SIZE, Packet, Reason, Repeat, Type, decode, encode
from tests.board.simulated import BOARD, Board, plugged_in

pytestmark = pytest.mark.slow

ALIVE, LOCKED, RECEIVING, BUSY, ERROR = (1 << k for k in range(5))

Compute = Callable[..., dict]


@pytest.fixture
def compute(softdepth, files) -> Compute:
    """Run the command against a board, demand success, and give its report."""

    def command(board: Board, out: Path, timeout: float = 1) -> dict:
        outcome = softdepth(
            *("board", "--port", board.path, "--baud", BOARD.baud, "--timeout", timeout),
            *(files.left, files.right, "--gt", files.truth, "-o", out),
        )
        assert outcome.code == 0, outcome.err
        assert "0 mismatches in 960 pixels" in outcome.out
        return json.loads((out / "report.json").read_text())

    return command


def test_a_clean_line(config, compute, tmp_path):
    with plugged_in(config, tmp_path) as board:
        report = compute(
            board, tmp_path / "out", timeout=30
        )  # nothing is lost: all that is late is the machine
    assert report["config_hash"] == config.hash
    assert report["metrics"]["board"] == report["metrics"]["fixed"]
    assert report["metrics"]["board"]["bad1"] < 50
    link = report["link"]
    assert link.pop("sent") >= 24 + 4
    assert set(link.values()) == {0}
    assert board.record["led"] & (ALIVE | LOCKED | BUSY | ERROR) == ALIVE | LOCKED


def test_a_boards_own_core_without_a_border_band(compute, tmp_path):
    """Small: fractions, six codes and confidence, and results that come long after the last pixel."""
    own = BOARDS["ulx3s-85f"].config
    assert own.post.check
    keys = ("disparities=8", "lanes=4", "max_width=64", "max_height=64", "post.masked_median=2")
    with plugged_in(own.override(keys), tmp_path) as board:
        compute(board, tmp_path / "out", timeout=30)


def test_a_sequence(config, softdepth, files, tmp_path):
    for side, path in (("left", files.left), ("right", files.right)):
        (tmp_path / side).mkdir()
        for k in range(2):
            shutil.copy(path, tmp_path / side / f"{k}.png")
    with plugged_in(config, tmp_path) as board:
        outcome = softdepth(
            *("board", "--port", board.path, "--baud", BOARD.baud, "--timeout", 30, "--processes", 1),
            *(tmp_path / "left", tmp_path / "right", "-o", tmp_path / "out"),
        )
    assert outcome.code == 0, outcome.err
    assert "gateware against fixed model: 0 mismatches" in outcome.out
    assert json.loads((tmp_path / "out" / "sequence.json").read_text())["engine_frames_per_second"] > 0


@pytest.mark.parametrize(
    ("to_board", "to_host"),
    [
        ({"flip": 0.001, "lead": [0x7D, 0x42, 0x7D]}, {"flip": 0.003}),
        ({"drop": 0.0005, "flip": 0.0005}, {"drop": 0.002}),
        ({"truncate": 0.25, "double": 0.1}, {"truncate": 0.1, "double": 0.1}),
    ],
    ids=["flipped", "dropped", "truncated-and-doubled"],
)
def test_a_line_that_spoils_packets(config, compute, tmp_path, to_board, to_host):
    with plugged_in(config, tmp_path, to_board, to_host) as board:
        report = compute(board, tmp_path / "out")
    assert board.record["to_board"][1] > 0
    assert board.record["to_host"][1] > 0
    link = report["link"]
    assert link["repeated"] > 0
    assert link["broken"] + link["timeouts"] > 0
    assert link["board_broken"] + link["board_gaps"] > 0


def test_unplugging_in_a_frame(config, softdepth, files, tmp_path):
    out = tmp_path / "out"
    with plugged_in(config, tmp_path, unplug=3000) as board:
        outcome = softdepth(
            *("board", "--port", board.path, "--baud", BOARD.baud, files.left, files.right, "-o", out)
        )
    assert outcome.code == 2
    assert "was unplugged or switched off" in outcome.error
    assert not out.exists()


class Raw:
    """A host that says what it likes."""

    def __init__(self, port: Port) -> None:
        self.port = port
        self.rest = b""

    def replies(self, data: bytes, count: int = 1) -> list[Packet | None]:
        """The next packets from the board after these bytes."""
        self.port.write(data)
        found: list[Packet | None] = []
        while len(found) < count:
            came = self.port.read(10)
            assert came, "the board does not answer"
            *framed, self.rest = (self.rest + came).split(bytes([FLAG]))
            found += [decode(part) for part in framed if part]
        assert len(found) == count
        return found

    def reply(self, kind: int, sequence: int, payload: bytes = b"", version: int = 1) -> Packet:
        """The reply to one request."""
        (found,) = self.replies(encode(Packet(kind, sequence, payload, version)))
        assert found is not None
        return found

    def refusal(self, *request: int | bytes, version: int = 1) -> Reason:
        """The reason of the error that a request gets."""
        found = self.reply(*request, version=version)  # type: ignore[arg-type]
        assert (found.type, found.sequence) == (REPLY | Type.ERROR, request[1])
        return Reason(found.payload[0])


@pytest.fixture
def raw(config: Config, tmp_path: Path) -> Iterator[Raw]:
    """A board fresh from reset, and a raw host."""
    with plugged_in(config, tmp_path) as board, Port(board.path, BOARD.baud) as port:
        yield Raw(port)


def test_the_boards_side_of_the_protocol(raw: Raw, config: Config):
    line = bytes(8 * 6)
    size = SIZE.pack(8, 4)
    # before a session
    assert raw.refusal(Type.BEGIN, 0, size) == Reason.SESSION
    assert raw.refusal(Type.HELLO, 0, version=2) == Reason.VERSION
    # its beginning; sequence numbers wrap
    assert raw.reply(Type.HELLO, 0xFFFD).sequence == 0xFFFD
    assert raw.reply(Type.STATUS, 0xFFFE).payload[:2] == b"\x01\x00"
    assert raw.refusal(99, 0xFFFF) == Reason.TYPE
    # sizes and order
    for wrong in (
        SIZE.pack(config.min_width - 1, 4),
        SIZE.pack(65, 4),
        SIZE.pack(8, 0),
        SIZE.pack(8, 65),
        SIZE.pack(0xFFFF, 0xFFFF),
    ):
        assert raw.refusal(Type.BEGIN, 0xFFFF, wrong) == Reason.SIZE
    assert raw.refusal(Type.BEGIN, 0xFFFF, size + b"\0") == Reason.ORDER
    assert raw.refusal(Type.LINE, 0xFFFF, line) == Reason.ORDER
    begun = raw.reply(Type.BEGIN, 0xFFFF, size)
    assert begun == Packet(REPLY | Type.BEGIN, 0xFFFF)
    assert raw.reply(Type.BEGIN, 0xFFFF, size) == begun  # once more, and nothing new begins
    assert raw.refusal(Type.BEGIN, 0, size) == Reason.ORDER
    assert raw.refusal(Type.LINE, 0, line[:-1]) == Reason.ORDER
    assert raw.refusal(Type.LINE, 0, line + bytes(6)) == Reason.ORDER
    # a gap, and a broken packet
    assert raw.reply(Type.LINE, 5, line) == Packet(REPLY | Type.REPEAT, 0, bytes([Repeat.GAP]))
    spoilt = bytearray(encode(Packet(Type.LINE, 0, line)))
    spoilt[20] ^= 1
    broken = raw.replies(bytes(spoilt))
    assert broken == [Packet(REPLY | Type.REPEAT, 0, bytes([Repeat.BROKEN]))]
    # the frame: each line twice, each fetch twice, with the same reply
    got = []
    for number in range(4):
        first = raw.reply(Type.LINE, number, line)
        assert raw.reply(Type.LINE, number, line) == first
        got.append(first.payload)
    assert raw.refusal(Type.LINE, 4, line) == Reason.ORDER  # one too many
    for number in range(4, 12):
        first = raw.reply(Type.FETCH, number)
        assert raw.reply(Type.FETCH, number) == first
        got.append(first.payload)
    rows = [reply for reply in got if reply]
    assert [int.from_bytes(row[:2], "little") for row in rows] == [0, 1, 2, 3]
    flat = np.zeros((4, 8, 3), np.uint8)
    expected = fixed_model.disparity(flat, flat, config).mirrored()
    words = expected.disparity | expected.code.astype(np.uint16) << config.result_bits
    assert [list(row[2:]) for row in rows] == words.tolist()
    # with the frame out, the next may begin
    assert raw.reply(Type.BEGIN, 12, size).type == REPLY | Type.BEGIN


def test_a_host_that_dies_in_a_frame_leaves_a_sound_board(raw: Raw, config: Config):
    raw.reply(Type.HELLO, 7)
    raw.reply(Type.BEGIN, 8, SIZE.pack(20, 10))
    for number in range(5):
        raw.reply(Type.LINE, 9 + number, np.random.default_rng(number).bytes(120))
    raw.port.write(encode(Packet(Type.LINE, 14, bytes(120)))[:70])
    left, right = np.random.default_rng(1).integers(0, 256, (2, 7, 31, 3), dtype=np.uint8)
    device = Device(Link(raw.port, 2))
    for _ in range(2):
        found = device.disparity(left, right)
        assert list(fixed_model.disparity(left, right, config).differences(found)) == []
