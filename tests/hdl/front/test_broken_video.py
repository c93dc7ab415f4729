"""FrameGuard against the fault table: thousands of random broken frames, right after reset."""

from collections.abc import Iterator
from functools import cache
from random import Random
from typing import Any

import pytest

from softdepth.hdl.front.frame_guard import FrameGuard
from tests.support.broken_video import broken_video, pauses
from tests.support.fault_table import Mended, mended
from tests.support.frames import frames, partner
from tests.support.mutations import COLUMNS, FRAME_GUARD, HEIGHT_LEARNER, mutated_guard
from tests.support.simulation import config, pair, sad
from tests.support.trials import Outcome, Trial, run_trials

CONFIGS = {
    "3x3": config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2, max_width=9, max_height=8),
    "7x7": config(cost="sad", criteria=[sad(7)], disparities=4, lanes=2, max_width=10, max_height=8),
    "one width": config(cost="sad", criteria=[sad(9)], disparities=4, lanes=2, max_width=9, max_height=9),
}
RATES = ((1.0, 1.0), (1.0, 1.0), (0.6, 1.0), (1.0, 0.6), (0.6, 0.6))


@cache
def _expected(seed: int, name: str) -> tuple[list[int], dict[int, int], Mended]:
    """The packed input of a seed, its silences, and what the table says of it, whose promises are checked."""
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
    return packed, pauses(stream, c), table


def first_difference(dut: Any, name: str, seeds: range) -> str:
    """What the first run of a guard says that departs from the table; empty if none does."""
    found: list[str] = []

    def trials() -> Iterator[Trial]:
        for seed in seeds:
            packed, silences, _ = _expected(seed, name)
            yield Trial(packed, *Random(seed).choice(RATES), pauses=silences)

    def judge(number: int, outcome: Outcome) -> bool:
        seed = seeds[number]
        expected = _expected(seed, name)[2]
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


@pytest.mark.slow
@pytest.mark.parametrize("name", CONFIGS)
def test_what_leaves_is_what_the_table_says(name: str) -> None:
    runs = range(400 if name == "3x3" else 80)  # of three to a dozen frames each
    assert not first_difference(FrameGuard(CONFIGS[name]), name, runs)


# Faults put into the gateware's text: a line of it, and what stands there instead.
MUTATIONS: dict[str, tuple[str, str, str]] = {
    "one frame teaches a height": (HEIGHT_LEARNER, "m.If(whole & agrees):", "m.If(whole):"),
    "two lower frames do": (HEIGHT_LEARNER, "whole & agrees & (streak == 2)", "whole & agrees"),
    "heights need not agree": (HEIGHT_LEARNER, "(streak != 0) & is_same", "(streak != 0)"),
    "broken frames are passed over": (HEIGHT_LEARNER, "m.d.sync += streak.eq(0)", "pass"),
    "two frames confirm a height": (HEIGHT_LEARNER, "confirmed.eq(0)", "confirmed.eq(1)"),
    "no height is confirmed": (HEIGHT_LEARNER, "confirmed.eq(1)", "confirmed.eq(0)"),
    "a taller frame is early": (HEIGHT_LEARNER, "m.If(line & ~frame & at_last):", "m.If(0):"),
    "silence ends nothing": (HEIGHT_LEARNER, "(knows_height & at_last) | (~marks & is_lowest)", "0"),
    "silence does not end the tallest": (HEIGHT_LEARNER, "(~marks & is_lowest)", "0"),
    "silence ends what is marked": (HEIGHT_LEARNER, "(~marks & is_lowest)", "is_lowest"),
    "a height is never forgotten": (HEIGHT_LEARNER, "overran & (overran_before | ~at_last)", "overran & 0"),
    "a multiple is forgiven each time": (HEIGHT_LEARNER, "(overran_before | ~at_last)", "~at_last"),
    "a multiple is never forgiven": (HEIGHT_LEARNER, "(overran_before | ~at_last)", "1"),
    "marks are forgotten": (HEIGHT_LEARNER, 'm.next = "MARKS"', "pass"),
    "the last row comes late": (
        HEIGHT_LEARNER,
        "row.eq(Mux(frame, 0, row + 1))",
        "row.eq(Mux(frame, 0, row + 1 - at_last))",
    ),
    "one line too many fits": (HEIGHT_LEARNER, "max_height - 1", "max_height"),
    "no frame ends early": (HEIGHT_LEARNER, "marks | (knows_height & ~at_last)", "0"),
    "lower frames are not early": (HEIGHT_LEARNER, "marks | (knows_height & ~at_last)", "marks"),
    "broken frames are whole": (
        FRAME_GUARD,
        'ends & may_leave & (starts | at["OVER"]) & ~so_far',
        'ends & may_leave & (starts | at["OVER"])',
    ),
    "what is too tall is not marked": (FRAME_GUARD, '(rest & at["LAST"]) | early', "early"),
    "damage is forgotten with its line": (
        FRAME_GUARD,
        "damaged.eq(so_far)",
        "damaged.eq(so_far & ~line_ends)",
    ),
    "damage outlives its frame": (FRAME_GUARD, "(damaged | hurt) & ~closed", "(damaged | hurt)"),
    "damage is forgotten at once": (FRAME_GUARD, "damaged.eq(so_far)", "damaged.eq(0)"),
    "damage comes late": (FRAME_GUARD, "(damaged | hurt) & ~closed", "damaged & ~closed"),
    "cut lines are not marked": (FRAME_GUARD, "found | short | cut", "found | short"),
    "short lines are not marked": (FRAME_GUARD, "found | short | cut", "found | cut"),
    "short lines are not counted": (FRAME_GUARD, "short_lines.eq(short | ", "short_lines.eq("),
    "what waits is counted each clock": (FRAME_GUARD, "counters.again.eq(self.o.valid & ~may_leave),", ""),
    "each dropped line is counted": (FRAME_GUARD, 'states.go("DROP")', "pass"),
    "an end in the rest is missed": (FRAME_GUARD, 'states.go("END")', 'states.go("BETWEEN")'),
    "starts in the rest do not count": (FRAME_GUARD, '(at["LINE"] | at["SKIP"])', 'at["LINE"]'),
    "the end is lost in filling": (FRAME_GUARD, "Mux(fills, end_waits, pair.eof)", "pair.eof"),
    "a start inside a line does not end it": (
        FRAME_GUARD,
        'pair.eof | (at["LINE"] & pair.sof)',
        "pair.eof",
    ),
    "the next frame fills the line": (FRAME_GUARD, '~own & ~(at["LINE"] & pair.sof)', "~own"),
    "narrow frames stay narrow": (COLUMNS, "config.min_width - 2", "config.min_width - 3"),
    "the width is a column late": (COLUMNS, "second_last.eq(previous)", "second_last.eq(x)"),
    "the width outlives its frame": (
        COLUMNS,
        "m.d.sync += first_line.eq(1)",
        "m.d.sync += first_line.eq(second_last == config.max_width - 2)",
    ),
}


@pytest.mark.parametrize("mutation", MUTATIONS)
def test_a_broken_guard_is_caught(mutation: str) -> None:
    guard = mutated_guard(*MUTATIONS[mutation])
    assert first_difference(guard(CONFIGS["3x3"]), "3x3", range(400))


def test_the_mutated_guard_without_a_fault_passes() -> None:
    guard = mutated_guard(FRAME_GUARD, "FrameGuard", "FrameGuard")
    assert not first_difference(guard(CONFIGS["3x3"]), "3x3", range(5))
