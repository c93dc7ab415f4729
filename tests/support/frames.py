"""Frames of numbered pixels: what a source sends, and what must be true of what the guard gives."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from softdepth.spec.config import Config, PixelFormat
from tests.support.simulation import pair

Lines = list[list[int]]


@dataclass
class Frame:
    """A frame as it left the guard: pixels by line, where damage was marked, and what ended it."""

    lines: Lines
    damaged: list[bool]
    end: str = "open"


def pixel(number: int, y: int, x: int) -> int:
    """Pixels that are all different."""
    return number << 16 | y << 8 | x


def lines(number: int, width: int, height: int) -> Lines:
    """The pixels of a frame."""
    return [line_of(number, y, width) for y in range(height)]


def line_of(number: int, y: int, width: int) -> list[int]:
    """One line of a frame."""
    return [pixel(number, y, x) for x in range(width)]


def padded(line: list[int], width: int) -> list[int]:
    """A line that is filled with its last pixel."""
    return line + line[-1:] * (width - len(line))


def source(frame: Lines, *, eof: bool = True, marks: dict[tuple[int, int], str] | None = None) -> list[int]:
    """A frame's transfers. ``marks`` overrides the markers of single pixels: ``sof+eol``, or ``none``."""
    packed = []
    for y, line in enumerate(frame):
        for x, value in enumerate(line):
            found = {
                "sof": (x, y) == (0, 0),
                "eol": x == len(line) - 1,
                "eof": eof and x == len(line) - 1 and y == len(frame) - 1,
            }
            if marks and (x, y) in marks:
                found = {name: name in marks[x, y] for name in found}
            packed.append(pair(value, partner(value), **found))
    return packed


def partner(left: int) -> int:
    """The right pixel that comes with a left one."""
    return left ^ (2**PixelFormat.RGB8.size - 1)


def frames(items: Iterable[Any], c: Config) -> list[Frame]:
    """The frames among the guard's items; fails where they are not whole."""
    found: list[Frame] = []
    is_open = False
    fresh = True  # the next pixel begins a line
    for item in items:
        if item.end:
            assert is_open, "an end without a frame"
            assert fresh, "an end inside a line"
            assert not any((item.first, item.completes, item.inner, item.first_inner))
            found[-1].damaged.append(bool(item.damaged))
            found[-1].end, is_open = "end", False
            continue
        if item.sof:
            assert not is_open, "a start inside a frame"
            found.append(Frame([], []))
            is_open = fresh = True
        assert is_open, "a pixel outside any frame"
        frame = found[-1]
        if fresh:
            frame.lines.append([])
        line = frame.lines[-1]
        assert bool(item.sof) == (len(frame.lines) == 1 and fresh)
        assert item.x == len(line)
        support = c.reach_left + c.reach_right
        places = (item.x == c.reach_right, item.x >= support, item.x == support)
        assert (item.completes, item.inner, item.first_inner) == ((0, 0, 0) if item.sof else places)
        assert item.first == (item.x == 0)
        assert item.right == partner(item.left)
        line.append(item.left)
        frame.damaged.append(bool(item.damaged))
        assert frame.damaged == sorted(frame.damaged), "damage was forgotten within a frame"
        fresh = bool(item.eol)
        if fresh:
            assert len(line) == len(frame.lines[0]), "lines of different widths"
            assert c.min_width <= len(line) <= c.max_width
            assert len(frame.lines) <= c.max_height
        if item.eof:
            assert fresh, "an end of frame inside a line"
            frame.end, is_open = "eof", False
    assert fresh, "an unfinished line"
    assert all(frame.end != "open" for frame in found[:-1])
    return found
