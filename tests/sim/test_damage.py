"""Each kind of damage does what it says, and only that."""

import numpy as np
import pytest

from softdepth.hdl.signatures import pair_layout
from softdepth.sim import damage
from softdepth.sim.transfers import Payloads, pack_frame, unpack_field
from softdepth.spec.errors import InputError
from softdepth.spec.pixel import PixelFormat

HEIGHT, WIDTH = 9, 12


@pytest.fixture
def frame(pair: tuple[np.ndarray, np.ndarray]) -> Payloads:
    return pack_frame(*pair)


def marked(transfers: Payloads, marker: str) -> list[int]:
    return np.flatnonzero(unpack_field(pair_layout(PixelFormat.RGB8), marker, transfers)).tolist()


def line_lengths(transfers: Payloads) -> list[int]:
    return np.diff([-1, *marked(transfers, "eol")]).tolist()


@pytest.mark.parametrize("y", [0, 4, HEIGHT - 1])
def test_drops_pixels_and_keeps_the_markers(frame: Payloads, y: int) -> None:
    short = damage.drop_pixels(frame, y, 3)
    assert line_lengths(short) == [WIDTH - 3 if row == y else WIDTH for row in range(HEIGHT)]
    assert marked(short, "sof") == [0]
    assert marked(short, "eof") == [len(frame) - 4]
    assert np.isin(short, frame).all()


@pytest.mark.parametrize("count", [2, 3 * WIDTH])
@pytest.mark.parametrize("y", [0, 4, HEIGHT - 1])
def test_adds_pixels_without_markers(frame: Payloads, y: int, count: int) -> None:
    long = damage.add_pixels(frame, y, count)
    assert line_lengths(long) == [WIDTH + count if row == y else WIDTH for row in range(HEIGHT)]
    assert marked(long, "sof") == [0]
    assert marked(long, "eof") == [len(frame) + count - 1]


def test_drops_the_start(frame: Payloads) -> None:
    headless = damage.drop_start(frame)
    assert marked(headless, "sof") == []
    assert np.flatnonzero(headless != frame).tolist() == [0]


def test_drops_a_line_end(frame: Payloads) -> None:
    merged = damage.drop_line_end(frame, 2)
    assert line_lengths(merged) == [WIDTH, WIDTH, 2 * WIDTH, *[WIDTH] * (HEIGHT - 4)]
    assert np.flatnonzero(merged != frame).tolist() == [3 * WIDTH - 1]


@pytest.mark.parametrize(("y", "x"), [(3, 0), (3, 5), (0, 1)])
def test_truncates(frame: Payloads, y: int, x: int) -> None:
    assert np.array_equal(damage.truncate(frame, y, x), frame[: y * WIDTH + x])


def test_adds_a_start(frame: Payloads) -> None:
    assert marked(damage.add_start(frame, 3, 5), "sof") == [0, 3 * WIDTH + 5]
    assert marked(frame, "sof") == [0]


def test_refuses_lines_that_are_not_there(frame: Payloads) -> None:
    with pytest.raises(InputError, match="line 9 is not in a frame of 9 lines"):
        damage.drop_pixels(frame, HEIGHT, 1)
    with pytest.raises(InputError, match="cannot drop 12 of a line's 12 pixels"):
        damage.drop_pixels(frame, 0, WIDTH)
