"""Random streams as broken sources send them, each from reset on."""

from random import Random

from softdepth.hdl.front.silence import silent_clocks
from softdepth.spec.config import Config
from tests.support.fault_table import Sent

Stream = list[Sent]
SETTLING = 16
"""Clocks in which a pixel that was taken has surely passed, and its line's end is known."""


def good_frame(width: int, height: int, *, eof: bool) -> Stream:
    """A frame without fault; its pixels have yet to be numbered."""
    return [
        Sent(
            0,
            sof=(x, y) == (0, 0),
            eol=x == width - 1,
            eof=eof and (x, y) == (width - 1, height - 1),
        )
        for y in range(height)
        for x in range(width)
    ]


def some_size(random: Random, c: Config) -> tuple[int, int]:
    """A width and a height that the core takes, the extremes among them."""
    width = random.choice((c.min_width, c.min_width + 1, c.max_width - 1, c.max_width))
    return width, random.choice((1, 2, 2, 3, 3, 4, c.max_height - 1, c.max_height))


def unfit_frame(random: Random, c: Config, *, eof: bool) -> Stream:
    """A frame of a size that the core does not take, or noise."""
    width, height = some_size(random, c)
    match random.randrange(4):
        case 0:
            width = random.randrange(1, c.min_width)
        case 1:
            width = c.max_width + random.randrange(1, 4)
        case 2:
            height = c.max_height + random.randrange(1, 4)
            frame = good_frame(width, height, eof=eof)
            beyond = width * c.max_height
            frame[beyond] = frame[beyond]._replace(pause=random.random() < 0.5)
            return frame
        case 3:
            likely = (0.1, 0.3, 0.1 if eof else 0)
            return [Sent(0, *(random.random() < p for p in likely)) for _ in range(random.randrange(30))]
    return good_frame(width, height, eof=eof)


def broken(random: Random, frame: Stream, width: int) -> Stream:
    """The frame with one fault, which need not be seen: it may be cut at a line's end."""
    frame = list(frame)
    at = random.randrange(len(frame))
    match random.randrange(10):
        case 0 | 1:
            return frame[: max(at - at % width, 1)]  # cut at a line's end, or behind the first pixel
        case 2:
            return frame[: at + 1]
        case 3:
            return frame[:at] + frame[at + random.randrange(1, width) :]
        case 4:
            return frame[:at] + [Sent(0)] * random.randrange(1, width) + frame[at:]
        case 5:
            frame[0] = frame[0]._replace(sof=False)
        case 6:
            frame[at] = frame[at]._replace(sof=True)
        case 7:
            frame[at] = frame[at]._replace(eol=not frame[at].eol)
        case 8:
            frame[-1] = frame[-1]._replace(eof=False)
        case 9:
            frame[-1:-1] = [Sent(0)] * random.randrange(1, width)  # its last line is too long
    return frame


def some_frames(random: Random, c: Config, usual: tuple[int, int], *, eof: bool) -> Stream:
    """One of the things that sources do, often with frames of their usual size."""
    size = usual if random.random() < 0.6 else some_size(random, c)
    frame = good_frame(*size, eof=eof)
    match random.randrange(6):
        case 0:
            return frame * random.randrange(1, 4)
        case 1:
            return good_frame(size[0], random.randrange(1, c.max_height + 1), eof=eof) * random.randrange(
                1, 4
            )
        case 2:
            return unfit_frame(random, c, eof=eof)
        case 3:
            return broken(random, frame, size[0]) * random.randrange(1, 4)
    for _ in range(random.choice((1, 1, 2, 3))):
        frame = broken(random, frame, size[0]) or frame
    return frame


def interrupted(random: Random, stream: Stream) -> Stream:
    """The same with silences: most before lines, some anywhere."""
    likely = random.choice((0, 0, 0, 0.05, 0.3))
    behind_a_line = [False, *(pixel.eol or pixel.eof for pixel in stream[:-1])]
    return [
        pixel._replace(pause=pixel.pause or random.random() < likely * (1 if begins else 0.1))
        for pixel, begins in zip(stream, behind_a_line, strict=True)
    ]


def pauses(stream: Stream, c: Config) -> dict[int, int]:
    """The clocks for which a core waits for each pixel that a silence precedes."""
    return {number: silent_clocks(c) + SETTLING for number, pixel in enumerate(stream) if pixel.pause}


def numbered(stream: Stream) -> Stream:
    """The same with pixels that are all different."""
    return [pixel._replace(value=number) for number, pixel in enumerate(stream, start=1)]


def broken_video(seed: int, c: Config) -> tuple[Stream, int]:
    """Broken frames, some interrupted, then good ones of one size; and the place of the first.

    Sources of odd seeds mark no ends. Theirs are three good frames, and a first line that ends the last.
    """
    random = Random(seed)
    eof = seed % 2 == 0
    usual = random.randrange(c.min_width, c.max_width + 1), random.choice((1, 2, 2, 3, 3, 4, c.max_height))
    stream: Stream = []
    match random.randrange(10):
        case 0 | 1 | 2:
            stream += good_frame(*usual, eof=eof) * 2
        case 3:  # two that agree, but not in a row, and one of which a height would make an early start
            frame = good_frame(*usual, eof=eof)
            stream += [*frame, *frame[: usual[0] - 1], *frame, *good_frame(usual[0], 1, eof=eof)]
        case 4:
            stream += unfit_frame(random, c, eof=eof)
    for _ in range(random.randrange(1, 5)):
        stream += some_frames(random, c, usual, eof=eof)
    good = good_frame(*usual, eof=eof)
    ending = good if eof else [*good * 3, *good[: usual[0]]]
    return numbered([*interrupted(random, stream), *ending]), len(stream)
