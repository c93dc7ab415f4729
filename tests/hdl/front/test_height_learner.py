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
    """What was said in a frame: the line that was called the last, and whether its end was known at all."""

    last: int | None
    knows_end: bool


def said(sent: Sequence[Sent]) -> list[Said]:
    """Frames of the narrowest lines, at full rate: what is said as each line's last pixel is taken."""
    dut = HeightLearner(CONFIG)
    found: list[Said] = []

    async def clock(ctx: SimulatorContext, *names: str) -> tuple[bool, bool, bool]:
        for name in INPUTS:
            ctx.set(getattr(dut, name), name in names)
        _, _, *outputs = await ctx.tick().sample(dut.is_last, dut.is_lowest, dut.knows_end)
        return bool(outputs[0]), bool(outputs[1]), bool(outputs[2])

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for frame in sent:
            last, knows_end = None, False
            for row in range(frame.height):
                await clock(ctx, *(("line",) if row else ("frame", "line")))
                for _ in range(NARROWEST - 2):
                    await clock(ctx)
                marked = frame.mark and row == frame.height - 1
                is_last, is_lowest, knows_end = await clock(ctx, *(("mark",) if marked else ()))
                assert is_lowest == (row == MAX_HEIGHT - 1)
                if is_last:
                    assert last is None
                    last = row
            for _ in range(frame.dropped):  # lines of one pixel
                await clock(ctx, "dropped")
            if frame.whole and not frame.mark and last is None:  # else no start is needed to end it
                await clock(ctx, "whole")
            if frame.forget:
                await clock(ctx, "forget")
            found.append(Said(last, knows_end))

    simulate(dut, bench)
    return found


UNKNOWN = Said(None, False)
MARKS = Said(None, True)
LOWER = Said(None, True)  # the last line of a known height is not reached


def known(height: int) -> Said:
    return Said(height - 1, True)


CASES: dict[str, tuple[list[Sent], list[Said]]] = {
    "two frames": ([Sent(3)] * 4, [UNKNOWN] * 2 + [known(3)] * 2),
    "frames of one line": ([Sent(1)] * 4, [UNKNOWN] * 2 + [known(1)] * 2),
    "the greatest height": ([Sent(MAX_HEIGHT)] * 3, [UNKNOWN] * 2 + [known(MAX_HEIGHT)]),
    "frames that differ": ([Sent(3), Sent(4), Sent(3), Sent(4)], [UNKNOWN] * 4),
    "frames that are not whole": ([Sent(3, whole=False)] * 5, [UNKNOWN] * 5),
    "one between that is not whole": (
        [Sent(3), Sent(3, whole=False), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 4 + [known(3)],
    ),
    "a mark": ([Sent(3), Sent(3, mark=True), Sent(3), Sent(3), Sent(3)], [UNKNOWN] * 2 + [MARKS] * 3),
    "a mark where the height is known": (
        [Sent(3), Sent(3), Sent(3), Sent(2, mark=True), Sent(3)],
        [UNKNOWN] * 2 + [known(3), LOWER, MARKS],
    ),
    "two lower frames": (
        [Sent(3), Sent(3), Sent(2), Sent(2), Sent(3), Sent(2), Sent(3)],
        [UNKNOWN] * 2 + [LOWER] * 2 + [known(3), LOWER, known(3)],
    ),
    "three lower frames": (
        [Sent(5), Sent(5), Sent(2), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN] * 2 + [LOWER] * 3 + [known(2)],
    ),
    "a taller frame": (
        [Sent(3), Sent(3), Sent(3, dropped=2), Sent(5), Sent(5), Sent(5)],
        [UNKNOWN] * 2 + [known(3), UNKNOWN, UNKNOWN, known(5)],
    ),
    "a start that is missing": (
        [Sent(3), Sent(3), Sent(3, dropped=3), Sent(3), Sent(3, dropped=6), Sent(3)],
        [UNKNOWN] * 2 + [known(3)] * 4,
    ),
    "twice as high": (
        [Sent(3), Sent(3), Sent(3, dropped=3), Sent(3, dropped=3), Sent(6), Sent(6), Sent(6)],
        [UNKNOWN] * 2 + [known(3)] * 2 + [UNKNOWN] * 2 + [known(6)],
    ),
    "a mark that is forgotten": (
        [Sent(3, mark=True), Sent(3), Sent(3, forget=True), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN, MARKS, MARKS, UNKNOWN, UNKNOWN, known(2)],
    ),
    "a height that is forgotten, and learnt from two more": (
        [Sent(3), Sent(3), Sent(3, forget=True), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 2 + [known(3), UNKNOWN, UNKNOWN, known(3)],
    ),
    "a frame that is forgotten before it has taught": (
        [Sent(3, forget=True), Sent(3), Sent(3), Sent(3)],
        [UNKNOWN] * 3 + [known(3)],
    ),
    "a taller frame, then as before": (
        [Sent(2), Sent(2), Sent(2, dropped=1), Sent(2), Sent(2), Sent(2)],
        [UNKNOWN] * 2 + [known(2), UNKNOWN, UNKNOWN, known(2)],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_learnt(name: str) -> None:
    sent, expected = CASES[name]
    assert said(sent) == expected


def test_the_narrowest_line_is_long_enough() -> None:
    """`said` looks at a line's last pixel: the learner must be as fast as it says."""
    assert REPORT_CLOCKS == NARROWEST - 1
