"""HeightLearner: which frames teach it, and which line it says is the last."""

from collections.abc import Sequence
from typing import NamedTuple

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.front.height_learner import REPORT_CLOCKS, HeightLearner
from softdepth.spec.config import NARROWEST
from tests.support.simulation import config, sad, simulate

MAX_HEIGHT = 8
CONFIG = config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2, max_height=MAX_HEIGHT)
INPUTS = ("frame", "line", "whole", "dropped", "mark", "forget")


class Sent(NamedTuple):
    """A frame: its lines, those that follow its end, whether it is whole, marked, and forgotten at last."""

    height: int
    dropped: int = 0
    whole: bool = True
    mark: bool = False
    forget: bool = False


class Said(NamedTuple):
    """What was said in a frame: of which line that none can follow, of which that silence ends the frame, and
    of which lines that a start would come early."""

    last: int | None
    may_end: int | None
    early: int


def said(sent: Sequence[Sent]) -> list[Said]:
    """Frames of the narrowest lines, at full rate: what is said as each line's last pixel is taken."""
    dut = HeightLearner(CONFIG)
    found: list[Said] = []

    async def clock(ctx: SimulatorContext, *names: str) -> tuple[bool, bool, bool]:
        for name in INPUTS:
            ctx.set(getattr(dut, name), name in names)
        _, _, *outputs = await ctx.tick().sample(dut.is_last, dut.may_end, dut.is_early)
        return bool(outputs[0]), bool(outputs[1]), bool(outputs[2])

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for frame in sent:
            last, may_end, early = None, None, 0
            for row in range(frame.height):
                await clock(ctx, *(("line",) if row else ("frame", "line")))
                for _ in range(NARROWEST - 2):
                    await clock(ctx)
                marked = frame.mark and row == frame.height - 1
                said_of_it = await clock(ctx, *(("mark",) if marked else ()))
                last = row if said_of_it[0] else last
                may_end = row if said_of_it[1] else may_end
                early += said_of_it[2]
            for _ in range(frame.dropped):  # lines of one pixel
                await clock(ctx, "dropped")
            if frame.whole and not frame.mark and not frame.dropped:
                await clock(ctx, "whole")
            if frame.forget:
                await clock(ctx)
                await clock(ctx, "forget")
            found.append(Said(last, may_end, early))

    simulate(dut, bench)
    return found


UNKNOWN = Said(None, None, 0)


def marks(height: int) -> Said:
    """A start is early wherever it comes."""
    return Said(None, None, height)


def lower(height: int) -> Said:
    """The last line of a known height is not reached."""
    return Said(None, None, height)


def supposed(height: int) -> Said:
    return Said(None, height - 1, height - 1)


def known(height: int) -> Said:
    return Said(height - 1, height - 1, height - 1)


TALLEST = known(MAX_HEIGHT)._replace(early=0)
CASES: dict[str, tuple[list[Sent], list[Said]]] = {
    "three frames": ([Sent(3)] * 5, [UNKNOWN] * 2 + [supposed(3)] + [known(3)] * 2),
    "frames of one line": ([Sent(1)] * 4, [UNKNOWN] * 2 + [supposed(1), known(1)]),
    "the greatest height": ([Sent(MAX_HEIGHT)] * 3, [TALLEST] * 2 + [known(MAX_HEIGHT)]),
    "frames that differ": ([Sent(3), Sent(4), Sent(3), Sent(4)], [UNKNOWN] * 4),
    "frames that are not whole": ([Sent(3, whole=False)] * 5, [UNKNOWN] * 5),
    "one between that is not whole": (
        [Sent(3), Sent(3, whole=False), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 4 + [supposed(3)],
    ),
    "a mark": ([Sent(3), Sent(3, mark=True), Sent(3), Sent(3), Sent(3)], [UNKNOWN] * 2 + [marks(3)] * 3),
    "a mark where the height is known": (
        [Sent(3), Sent(3), Sent(3), Sent(2, mark=True), Sent(3)],
        [UNKNOWN] * 2 + [supposed(3), lower(2), marks(3)],
    ),
    "two lower frames": (
        [Sent(3), Sent(3), Sent(3), Sent(2), Sent(2), Sent(3), Sent(2), Sent(3)],
        [UNKNOWN] * 2 + [supposed(3)] + [lower(2)] * 2 + [known(3), lower(2), known(3)],
    ),
    "three lower frames": (
        [Sent(5), Sent(5), Sent(2), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN] * 2 + [lower(2)] * 3 + [known(2)],
    ),
    "a taller frame than two": (
        [Sent(3), Sent(3), Sent(5), Sent(5), Sent(5), Sent(5)],
        [UNKNOWN] * 2 + [Said(None, 2, 2), UNKNOWN, supposed(5), known(5)],
    ),
    "a taller frame than three": (
        [Sent(3), Sent(3), Sent(3), Sent(3, dropped=2), Sent(5), Sent(5), Sent(5)],
        [UNKNOWN] * 2 + [supposed(3), known(3), UNKNOWN, UNKNOWN, supposed(5)],
    ),
    "a start that is missing": (
        [Sent(3), Sent(3), Sent(3), Sent(3, dropped=3), Sent(3), Sent(3, dropped=6), Sent(3)],
        [UNKNOWN] * 2 + [supposed(3)] + [known(3)] * 4,
    ),
    "twice as high": (
        [*[Sent(3)] * 3, Sent(3, dropped=3), Sent(3, dropped=3), Sent(6), Sent(6), Sent(6)],
        [UNKNOWN] * 2 + [supposed(3)] + [known(3)] * 2 + [UNKNOWN] * 2 + [supposed(6)],
    ),
    "a mark that is forgotten": (
        [Sent(3, mark=True), Sent(3), Sent(3, forget=True), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN, marks(3), marks(3), UNKNOWN, UNKNOWN, supposed(2)],
    ),
    "a height that is forgotten, and learnt from two more": (
        [Sent(3), Sent(3), Sent(3, forget=True), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 2 + [supposed(3), UNKNOWN, UNKNOWN, supposed(3)],
    ),
    "a frame that is forgotten before it has taught": (
        [Sent(3, forget=True), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 3 + [supposed(3)],
    ),
    "a taller frame, then as before": (
        [Sent(2), Sent(2), Sent(2), Sent(2, dropped=1), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN] * 2 + [supposed(2), known(2), UNKNOWN, UNKNOWN, supposed(2)],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_learnt(name: str) -> None:
    sent, expected = CASES[name]
    assert said(sent) == expected


def test_the_narrowest_line_is_long_enough() -> None:
    """`said` looks at a line's last pixel: the learner must be as fast as it says."""
    assert REPORT_CLOCKS == NARROWEST - 1
