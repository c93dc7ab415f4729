"""FrameGuard: frames' heights, as they are learnt, confirmed and forgotten, and what ends a frame."""

from itertools import chain

import pytest

from softdepth.hdl.front.frame_guard import FrameGuard
from tests.support.frames import Frame, Lines, frames, lines, source
from tests.support.guarded import CONFIG, MAX_HEIGHT, PATIENCE, RATES, guarded
from tests.support.trials import Outcome, Trial, run_trials


@pytest.mark.parametrize("eof", [True, False])
@pytest.mark.parametrize("before", [[], [lines(0, 5, 2)]], ids=["first", "second"])
@pytest.mark.parametrize("rates", RATES)
def test_a_frame_too_tall_is_cut_and_marked(
    rates: tuple[float, float], before: list[Lines], eof: bool
) -> None:
    """The first frame too: nothing is known of it but that it does not fit."""
    high = lines(1, 5, MAX_HEIGHT + 2)
    after = lines(2, 5, 3)
    result = guarded([t for f in [*before, high, after] for t in source(f, eof=eof)], rates)
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got] == [*before, high[:MAX_HEIGHT], after]
    assert result.status == {"missing_starts": 1}
    cut = got[len(before)]
    assert (cut.end, cut.damaged) == ("end", [False] * (5 * MAX_HEIGHT) + [True])
    assert not any(any(f.damaged) for f in got if f is not cut)


@pytest.mark.parametrize("rates", RATES)
def test_a_source_without_ends_may_fill_the_greatest_height(rates: tuple[float, float]) -> None:
    sent = [lines(n, 5, MAX_HEIGHT) for n in range(4)]
    result = guarded([t for f in sent for t in source(f, eof=False)], rates)
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got] == sent
    assert not any(any(f.damaged) for f in got)
    assert result.status == {}


def unmarked(
    heights: list[int], rates: tuple[float, float]
) -> tuple[list[Lines], list[Frame], dict[str, int]]:
    """Frames of these heights without end marks: what was sent, what left, and the counters."""
    sent = [lines(n, 5, height) for n, height in enumerate(heights)]
    result = guarded([t for f in sent for t in source(f, eof=False)], rates)
    return sent, frames(result.payloads, CONFIG), result.status


@pytest.mark.parametrize("height", [1, 4])
@pytest.mark.parametrize("rates", RATES)
def test_after_two_frames_silence_ends_the_next(rates: tuple[float, float], height: int) -> None:
    for count in (1, 2, 3, 5):
        sent, got, status = unmarked([height] * count, rates)
        assert [f.lines for f in got] == sent
        assert [f.end for f in got] == ["end"] * (count - 1) + ["end" if count > 2 else "open"]
        assert not any(any(f.damaged) for f in got)
        assert status == {}


@pytest.mark.parametrize("rates", RATES)
@pytest.mark.parametrize(("old", "new"), [(5, 3), (4, 1)])
def test_a_lower_height_is_learnt_from_three_frames(old: int, new: int, rates: tuple[float, float]) -> None:
    """Nothing is lost meanwhile."""
    sent, got, status = unmarked([old, old, old, new, new, new, new, new], rates)
    assert [f.lines for f in got] == sent
    assert [f.end for f in got] == ["end"] * 8
    assert [any(f.damaged) for f in got] == [False] * 3 + [True] * 3 + [False] * 2
    assert status == {"early_starts": 3}


@pytest.mark.parametrize("rates", RATES)
@pytest.mark.parametrize(("old", "new"), [(3, 5), (2, 7), (1, MAX_HEIGHT - 1)])
def test_a_taller_frame_makes_the_height_forgotten(old: int, new: int, rates: tuple[float, float]) -> None:
    """One frame loses lines; twice where the heights are multiples, as after starts that went missing."""
    cut = 2 if new % old == 0 else 1
    sent, got, status = unmarked([old, old, old, *[new] * (cut + 4)], rates)
    kept = [old] * 3 + [old] * cut + [new] * 4
    assert [f.lines for f in got] == [f[:height] for f, height in zip(sent, kept, strict=True)]
    assert [f.end for f in got] == ["end"] * len(sent)
    assert [f.damaged[-1] for f in got] == [False] * 3 + [True] * cut + [False] * 4
    assert [any(f.damaged[:-1]) for f in got] == [False] * len(got)
    assert status == {"missing_starts": cut}


@pytest.mark.parametrize("rates", RATES)
@pytest.mark.parametrize("eof", [True, False])
@pytest.mark.parametrize("height", [1, 2, 3])
def test_two_frames_cut_alike_do_no_harm(height: int, eof: bool, rates: tuple[float, float]) -> None:
    """The height that they seem to have is not confirmed: the good frame that follows is complete."""
    sent = [lines(n, 5, height) for n in range(2)] + [lines(n, 5, 5) for n in range(2, 5)]
    parts = [source(f, eof=eof and len(f) == 5) for f in sent]
    result = guarded(list(chain.from_iterable(parts)), rates)
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got] == sent
    assert not any(any(f.damaged) for f in got)
    assert [f.end for f in got[2:]] == ["eof" if eof else "end"] * 3
    assert result.status == {}


def after_a_pause(heights: list[int], rest: list[int]) -> tuple[list[Frame], dict[str, int]]:
    """Frames without end marks, and what comes when the silence after them is over."""
    sent = [t for n, height in enumerate(heights) for t in source(lines(n, 5, height), eof=False)]
    found: list[tuple[list[Frame], dict[str, int]]] = []

    def judge(_: int, outcome: Outcome) -> bool:
        found.append((frames(outcome.payloads, CONFIG), outcome.status))
        return True

    trial = Trial([*sent, *rest], pauses={len(sent): PATIENCE})
    run_trials(FrameGuard(CONFIG), [trial], judge, patience=PATIENCE)
    return found[0]


@pytest.mark.parametrize("count", [2, 3])
def test_the_end_has_left_where_lines_come_after_a_pause(count: int) -> None:
    """Nothing can tell of it in the frame: they are dropped and counted, and the height is forgotten."""
    beyond = source(lines(8, 5, 2), eof=False, marks={(0, 0): "none"})
    good = [lines(n, 5, 5) for n in (9, 10)]
    got, status = after_a_pause(
        [3] * (count + 1), [*beyond, *(t for f in good for t in source(f, eof=False))]
    )
    assert [len(f.lines) for f in got] == [3] * (count + 1) + [5, 5]
    assert [f.end for f in got] == ["end"] * (count + 2) + ["open"]
    assert not any(any(f.damaged) for f in got)
    assert status == {"missing_starts": 1}


def test_silence_ends_no_frame_of_a_source_that_marks_its_ends() -> None:
    marked = source(lines(8, 5, 2))
    sent = lines(9, 5, 4)
    packed = source(sent)
    found: list[list[Frame]] = []

    def judge(_: int, outcome: Outcome) -> bool:
        found.append(frames(outcome.payloads, CONFIG))
        assert outcome.status == {}
        return True

    pauses = dict.fromkeys(range(len(marked), len(marked) + len(packed), 5), PATIENCE)
    trial = Trial([*marked, *packed], pauses=pauses)
    run_trials(FrameGuard(CONFIG), [trial], judge, patience=2 * PATIENCE)
    assert found[0][1].lines == sent
    assert [f.end for f in found[0]] == ["eof"] * 2


@pytest.mark.parametrize("parts", [[2], [3], [2, 2]])
def test_one_broken_frame_does_not_change_the_learnt_height(parts: list[int]) -> None:
    """A frame is cut short, or a start of frame in its middle makes two of it."""
    sent, got, _ = unmarked([4, 4, 4, *parts, 4, 4], (1.0, 1.0))
    assert [f.lines for f in got] == sent
    assert [f.end for f in got] == ["end"] * len(sent)
    assert [any(f.damaged) for f in got] == [False] * 3 + [True] * len(parts) + [False] * 2


def test_one_start_that_is_missing_does_not_change_the_learnt_height() -> None:
    """The frame before may be the one that has too many lines, and is marked."""
    sent = [lines(n, 5, 4) for n in range(6)]
    transfers = [source(f, eof=False) for f in sent]
    transfers[4] = source(sent[4], eof=False, marks={(0, 0): "none"})
    result = guarded(list(chain.from_iterable(transfers)), (1.0, 1.0))
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got] == [*sent[:4], sent[5]]
    assert [f.end for f in got] == ["end"] * 5
    assert [f.damaged[-1] for f in got] == [False, False, False, True, False]
    assert result.status == {"missing_starts": 1}


@pytest.mark.parametrize("eof", [True, False])
@pytest.mark.parametrize(
    "cut", [(2, 3), (2, 0), (1, 1)], ids=["in a line", "at a line", "in the second line"]
)
def test_a_first_frame_that_was_cut_teaches_nothing(cut: tuple[int, int], eof: bool) -> None:
    rows, columns = cut
    sent = lines(1, 8, 5)
    part = source(sent[:rows], eof=False) + source(sent, eof=False)[8 * rows : 8 * rows + columns]
    good = [lines(n, 8, 5) for n in (2, 3)]
    result = guarded([*part, *(t for f in good for t in source(f, eof=eof))], (1.0, 1.0))
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got[1:]] == good
    assert any(got[0].damaged) == (columns > 0)
    assert not any(any(f.damaged) for f in got[1:])
    assert result.status == ({"early_starts": 1, "short_lines": 1} if columns else {})
