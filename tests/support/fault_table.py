"""The fault table of docs/gateware.md in plain Python: which frames must leave, and what is counted.

It looks at a whole stream at once, frame by frame and line by line. Rows of the table are named in comments.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from softdepth.spec.config import Config
from tests.support.frames import Frame

TO_LEARN = 2
"""Whole frames in a row that teach a height, where none is known."""
TO_CONFIRM = 3
"""The same where one is known already: to change it, or to be sure of it."""


class Sent(NamedTuple):
    """A pixel of the left view (the right one follows from it), its markers, and if silence precedes it."""

    value: int
    sof: bool = False
    eol: bool = False
    eof: bool = False
    pause: bool = False


class Mended(NamedTuple):
    """What leaves the guard, and the counters above zero."""

    frames: list[Frame]
    counters: dict[str, int]


@dataclass
class _Source:
    """What is known of how the source ends its frames. ``height`` is 0 while there is nothing to go by."""

    marks: bool = False
    height: int = 0
    confirmed: bool = False
    run: list[int] = field(default_factory=list)
    overran: bool = False

    @property
    def confirmed_height(self) -> int:
        return self.height if self.confirmed and not self.marks else 0

    def frame_over(self, whole_height: int | None, dropped_lines: int) -> None:
        """The next frame starts: the height of this one if it was whole, and the lines behind its end."""
        self.run = [*self.run, whole_height] if whole_height else []
        if self.marks:
            return
        enough = TO_CONFIRM if self.height else TO_LEARN
        newest = self.run[-enough:]
        if len(newest) == enough and len(set(newest)) == 1:
            self.confirmed = self.height > 0
            self.height = newest[0]
        if self.height and dropped_lines:
            self.run = []
            if self.overran or dropped_lines % self.height:
                self.height, self.overran = 0, False
                return
        self.overran = self.height > 0 and dropped_lines > 0


def mended(stream: Sequence[Sent], c: Config) -> Mended:
    """What must become of a stream that begins at reset; a frame that goes on at its end is ``open``."""
    source = _Source()
    counters: Counter[str] = Counter()
    found: list[Frame] = []
    starts = [k for k, pixel in enumerate(stream) if pixel.sof]
    before = stream[: starts[0]] if starts else stream
    counters["missing_starts"] += bool(before)  # "pixels outside any frame"
    source.marks = any(pixel.eof for pixel in before)
    for start, end in zip(starts, [*starts[1:], None], strict=True):
        sent = stream[start:end]
        frame, whole, dropped = _frame(sent, c, source, counters, followed=end is not None)
        found.append(frame)
        source.marks |= any(pixel.eof for pixel in sent)
        source.frame_over(len(frame.lines) if whole else None, dropped)
    return Mended(found, {name: count for name, count in counters.items() if count})


def _frame(
    sent: Sequence[Sent], c: Config, source: _Source, counters: Counter[str], followed: bool
) -> tuple[Frame, bool, int]:
    """A frame from its start to the next; whether it was whole and unmarked; the lines behind its end."""
    pixels: list[list[int]] = []
    broken_at: int | None = None  # the pixel from which it is damaged
    count = 0
    end = ""
    lines = list(_lines(sent))
    whole = False
    for number, line in enumerate(lines):
        may_end = number > 0 and not source.marks and number in (source.height, c.max_height)
        if may_end and line[0].pause:  # "the same after a silence"
            end = "end"
            whole = broken_at is None
            break
        if number == source.height and number and not source.marks and not source.confirmed:
            source.height = 0  # "more lines than a height that is supposed"
        if number == c.max_height or (number and number == source.confirmed_height):
            end = "end"  # "more lines than max_height", or "than a height that is confirmed"
            broken_at = count if broken_at is None else broken_at
            break
        narrowest, widest = (len(pixels[0]),) * 2 if pixels else (c.min_width, c.max_width)
        torn = not (line[-1].eol or line[-1].eof)
        kept = [pixel.value for pixel in line[:widest]]
        fault: int | None = None
        if len(kept) == widest and not (line[widest - 1].eol or line[widest - 1].eof):
            counters["long_lines"] += 1
            fault = widest - 1
            if torn and followed:  # "start in the dropped rest of a long line"
                counters["early_starts"] += 1
                end = "end"
            elif line[-1].eof:
                end = "end"
        elif torn and followed:  # "start inside a line"
            counters["early_starts"] += 1
            counters["short_lines"] += 1
            fault = len(kept)
            kept += kept[-1:] * max(narrowest - len(kept), 1)
            end = "eof"
        elif not torn:
            if len(kept) < narrowest:
                counters["short_lines"] += 1
                fault = len(kept) - 1
                kept += kept[-1:] * (narrowest - len(kept))
            if line[-1].eof:
                end = "eof"
        if fault is not None and broken_at is None:
            broken_at = count + fault
        pixels.append(kept)
        count += len(kept)
        if end:
            break
    behind = lines[len(pixels) :]
    counters["missing_starts"] += bool(behind)
    height = len(pixels)
    if not end and followed:  # "start after a whole line"
        end = "end"
        whole = broken_at is None
        if source.marks or source.height > height:
            counters["early_starts"] += 1
            broken_at = count if broken_at is None else broken_at
    elif not end and not torn and not source.marks and height in (source.height, c.max_height):
        end = "end"  # "silence"
    items = count + (end == "end")
    damaged = [broken_at is not None and k >= broken_at for k in range(items)]
    dropped = sum(line[-1].eol or line[-1].eof for line in behind)
    return Frame(pixels, damaged, end or "open"), whole, dropped


def _lines(sent: Sequence[Sent]) -> Iterator[Sequence[Sent]]:
    """Cut behind each end of line or frame; the last line may lack its end."""
    begin = 0
    for k, pixel in enumerate(sent, start=1):
        if pixel.eol or pixel.eof or k == len(sent):
            yield sent[begin:k]
            begin = k
