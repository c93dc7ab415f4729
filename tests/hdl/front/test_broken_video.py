"""FrameGuard against the fault table: thousands of random broken frames, right after reset."""

from collections.abc import Iterator
from functools import cache
from random import Random
from typing import Any

import pytest

from softdepth.hdl.front.frame_guard import FrameGuard
from tests.support.broken_video import broken_video
from tests.support.fault_table import Mended, mended
from tests.support.frames import frames, partner
from tests.support.simulation import config, pair, sad
from tests.support.trials import Outcome, Trial, run_trials

CONFIGS = {
    "3x3": config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2, max_width=9, max_height=8),
    "7x7": config(cost="sad", criteria=[sad(7)], disparities=4, lanes=2, max_width=10, max_height=8),
    "one width": config(cost="sad", criteria=[sad(9)], disparities=4, lanes=2, max_width=9, max_height=9),
}
RATES = ((1.0, 1.0), (1.0, 1.0), (0.6, 1.0), (1.0, 0.6), (0.6, 0.6))


@cache
def _expected(seed: int, name: str) -> tuple[list[int], Mended]:
    """The packed input of a seed, and what the table says of it; the table's own promises are checked."""
    c = CONFIGS[name]
    stream, good_from = broken_video(seed, c)
    table = mended(stream, c)
    good = [pixel.value for pixel in stream[good_from:]]
    width = next(k for k, pixel in enumerate(stream[good_from:], start=1) if pixel.eol)
    (first,) = [f for f in table.frames if f.lines[0][0] == good[0]]
    sent = [pixel for pixel in stream if pixel.value > good_from]
    height = next((k for k, p in enumerate(sent[1:], start=1) if p.sof), len(sent)) // width
    if len(first.lines) == height:  # not so where another height was learnt before
        assert first.lines == [good[y * width : (y + 1) * width] for y in range(height)]
        assert first.end == ("eof" if stream[-1].eof else first.end)
    packed = [pair(p.value, partner(p.value), sof=p.sof, eol=p.eol, eof=p.eof) for p in stream]
    return packed, table


def first_difference(dut: Any, name: str, seeds: range) -> str:
    """What the first run of a guard says that departs from the table; empty if none does."""
    found: list[str] = []

    def trials() -> Iterator[Trial]:
        for seed in seeds:
            yield Trial(_expected(seed, name)[0], *Random(seed).choice(RATES))

    def judge(number: int, outcome: Outcome) -> bool:
        seed = seeds[number]
        expected = _expected(seed, name)[1]
        got = frames(outcome.payloads, CONFIGS[name])
        if (got, outcome.status) != (expected.frames, expected.counters):
            at = next(
                (k for k, pair in enumerate(zip(got, expected.frames, strict=False)) if pair[0] != pair[1]),
                -1,
            )
            found.append(
                f"seed {seed}: frame {at} is\n{got[at]}\nand not\n{expected.frames[at]}\n"
                f"{outcome.status} and not {expected.counters}"
            )
        return not found

    try:
        run_trials(dut, trials(), judge, patience=40)
    except AssertionError as broken:  # not even whole frames
        found.append(str(broken) or "not whole")
    return found[0] if found else ""


@pytest.mark.parametrize("name", CONFIGS)
def test_what_leaves_is_what_the_table_says(name: str) -> None:
    assert not first_difference(FrameGuard(CONFIGS[name]), name, range(150))
