"""Random streams as broken sources send them, each from reset on."""

from random import Random

from softdepth.spec.config import Config
from tests.support.fault_table import Sent

Stream = list[Sent]


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


def broken_frame(random: Random, c: Config, *, eof: bool) -> Stream:
    """A frame with one fault or several, or none that can be seen: it may be cut at a line's end."""
    width = random.choice((c.min_width, c.min_width + 1, c.max_width - 1, c.max_width))
    height = random.choice((1, 2, 2, 3, 3, 4, c.max_height - 1, c.max_height))
    match random.randrange(12):
        case 0:
            width = random.randrange(1, c.min_width)
        case 1:
            width = c.max_width + random.randrange(1, 4)
        case 2:
            height = c.max_height + random.randrange(1, 4)
        case 3:
            return [
                Sent(0, *(random.random() < likely for likely in (0.1, 0.3, 0.1 if eof else 0)))
                for _ in range(random.randrange(30))
            ]
    frame = good_frame(width, height, eof=eof)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        at = random.randrange(len(frame))
        match random.randrange(9):
            case 0 | 1:
                frame = frame[: max(at - at % width, 1)]  # cut at a line's end
            case 2:
                frame = frame[: at + 1]
            case 3:
                del frame[at : at + random.randrange(1, max(width, 2))]
            case 4:
                frame[at:at] = [Sent(0)] * random.randrange(1, max(width, 2))
            case 5:
                frame[0] = frame[0]._replace(sof=False)
            case 6:
                frame[at] = frame[at]._replace(sof=True)
            case 7:
                frame[at] = frame[at]._replace(eol=not frame[at].eol)
            case 8:
                frame[-1] = frame[-1]._replace(eof=False)
        if not frame:
            break
    return frame


def numbered(stream: Stream) -> Stream:
    """The same with pixels that are all different."""
    return [pixel._replace(value=number) for number, pixel in enumerate(stream, start=1)]


def broken_video(seed: int, c: Config) -> tuple[Stream, int]:
    """Broken frames, then good ones of one size; and the place of the first good one's start.

    Sources of odd seeds mark no ends. Theirs are three good frames, and a first line that ends the last.
    """
    random = Random(seed)
    eof = seed % 2 == 0
    stream = [pixel for _ in range(random.randrange(1, 6)) for pixel in broken_frame(random, c, eof=eof)]
    size = random.randrange(c.min_width, c.max_width + 1), random.choice((1, 2, 2, 3, 3, 4, c.max_height))
    good = good_frame(*size, eof=eof)
    ending = good if eof else [*good * 3, *good[: size[0]]]
    return numbered([*stream, *ending]), len(stream)
