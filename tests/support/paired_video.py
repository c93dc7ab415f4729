"""Two views' streams and what must leave the pair synchroniser, in plain Python."""

from collections.abc import Sequence
from random import Random
from typing import NamedTuple

from softdepth.spec.config import Config
from tests.support.broken_video import Stream, broken, good_frame, numbered
from tests.support.fault_table import Sent


class Pair(NamedTuple):
    """A pixel of each view, and their marks."""

    left: int
    right: int
    sof: bool
    last: bool


class Joined(NamedTuple):
    """What leaves, and how often alignment was lost."""

    pairs: list[Pair]
    losses: int


def joined(left: Sequence[Sent], right: Sequence[Sent], *, skew: int, width: int = 0) -> Joined:
    """What must leave of whole streams. `width`: lines end by their length."""
    pairs: list[Pair] = []
    views, at = (left, right), [0, 0]
    losses, limit = 0, skew
    column, count, whole = 0, 0, False

    def put(sof: bool, last: bool) -> None:
        nonlocal column
        pairs.append(Pair(*(view[k].value for view, k in zip(views, at, strict=True)), sof, last))
        column = 1 if sof else column + 1
        if (width and column == width) or (not width and last):
            column = 0

    def there() -> bool:
        return all(k < len(view) for view, k in zip(views, at, strict=True))

    while there():
        one, other = (view[k] for view, k in zip(views, at, strict=True))
        agree = one.sof == other.sof and (width > 0 or one.eol == other.eol)
        if one.sof == other.sof:
            if one.sof:
                limit = count // 2 if whole else limit
                count, whole = 0, True
            count += 1
            put(one.sof, one.eol and other.eol)
            at = [k + 1 for k in at]
        elif column == 0:
            put(False, False)
            count += 1
            at[one.sof] += 1
        if agree:
            continue
        losses += 1
        whole, given_up = False, False
        dropped = [0, 0]
        while there():
            heads = [view[k].sof for view, k in zip(views, at, strict=True)]
            if all(heads):
                break
            if any(heads):
                # The one that waits is given up before the other drops more than that.
                waits = heads.index(True)
                if not given_up and dropped[1 - waits] - dropped[waits] >= limit:
                    at[waits] += 1
                    given_up = True
            for k in range(2):
                if not heads[k]:
                    at[k] += 1
                    dropped[k] += 1
    return Joined(pairs, losses)


def broken_views(seed: int, c: Config, *, frames: int = 8) -> tuple[Stream, Stream]:
    """Frames of one size, of which each view has some that are broken; the last two are good in both."""
    random = Random(seed)
    size = random.randrange(c.min_width, c.max_width + 1), random.choice((1, 2, 3, 4, c.max_height))
    streams: tuple[Stream, Stream] = ([], [])
    for number in range(frames):
        for stream in streams:
            frame = good_frame(*size, eof=False)
            while number < frames - 2 and random.random() < 0.3:
                frame = broken(random, frame, size[0]) or frame
            stream.extend(frame)
    left, right = (numbered(stream) for stream in streams)
    return left, right
