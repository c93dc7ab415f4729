"""FrameGuard: sound frames pass, and every kind of damage comes out as whole frames."""

from itertools import chain
from random import Random

import pytest

from softdepth.hdl.front.frame_guard import FrameGuard
from softdepth.hdl.front.silence import silent_clocks
from tests.support.frames import Frame, Lines, frames, line_of, lines, padded, partner, source
from tests.support.simulation import Transfers, config, pair, sad, stream_through
from tests.support.trials import Outcome, Trial, run_trials

MAX_WIDTH = 10
MAX_HEIGHT = 8
CONFIG = config(
    cost="sum", criteria=[sad(3)], disparities=4, lanes=2, max_width=MAX_WIDTH, max_height=MAX_HEIGHT
)
MIN_WIDTH = CONFIG.min_width
PATIENCE = 2 * silent_clocks(CONFIG)

RATES = [(1.0, 1.0), (0.5, 1.0), (0.7, 0.6)]


def guarded(transfers: list[int], rates: tuple[float, float], seed: int = 1) -> Transfers:
    return stream_through(
        FrameGuard(CONFIG), transfers, i_rate=rates[0], o_rate=rates[1], seed=seed, patience=PATIENCE
    )


SIZES = [(5, 3), (5, 3), (MAX_WIDTH, 2), (MIN_WIDTH, MAX_HEIGHT), (7, 1), (MAX_WIDTH, MAX_HEIGHT), (5, 3)]


@pytest.mark.parametrize("rates", RATES)
def test_sound_frames_pass_unchanged(rates: tuple[float, float]) -> None:
    sent = [lines(n, *size) for n, size in enumerate(SIZES)]
    result = guarded(list(chain.from_iterable(map(source, sent))), rates)
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got] == sent
    assert [f.end for f in got] == ["eof"] * len(sent)
    assert not any(any(f.damaged) for f in got)
    assert result.status == {}
    assert result.given == result.taken  # in the same clock
    if rates == (1.0, 1.0):
        assert result.taken == list(range(len(result.taken)))  # and none is lost


@pytest.mark.parametrize("dx", [-2, -1, 0, 1, 2])
def test_places_for_any_support(dx: int) -> None:
    """`frames` checks them; the support reaches further to one side, and to the other not at all."""
    c = config(cost="sum", criteria=[sad(3, dx)], disparities=4, lanes=2, max_width=12, max_height=MAX_HEIGHT)
    sent = [lines(n, width, 3) for n, width in enumerate((c.min_width, 12, 7, 7))]
    transfers = list(chain.from_iterable(map(source, sent)))
    result = stream_through(FrameGuard(c), transfers, i_rate=0.8, o_rate=0.8, seed=dx + 9)
    assert [f.lines for f in frames(result.payloads, c)] == sent


def test_an_end_of_frame_is_an_end_of_line() -> None:
    sent = lines(1, 5, 3)
    result = guarded(source(sent, marks={(4, 2): "eof"}), (1.0, 1.0))
    (got,) = frames(result.payloads, CONFIG)
    assert (got.lines, got.end, any(got.damaged)) == (sent, "eof", False)


# Damages to a frame of 5 x 3 pixels. For each: what is sent, what leaves, what ends it, the line in
# which damage is first marked, and the counters.
GOOD = lines(1, 5, 3)
Case = tuple[list[int], Lines | None, str, int | None, dict[str, int]]


DAMAGE: dict[str, Case] = {
    "short line": (
        source([GOOD[0], GOOD[1][:3], GOOD[2]]),
        [GOOD[0], padded(GOOD[1][:3], 5), GOOD[2]],
        "eof",
        1,
        {"short_lines": 1},
    ),
    "line of one pixel": (
        source([GOOD[0], GOOD[1][:1], GOOD[2]]),
        [GOOD[0], padded(GOOD[1][:1], 5), GOOD[2]],
        "eof",
        1,
        {"short_lines": 1},
    ),
    "two short lines": (
        source([GOOD[0], GOOD[1][:4], GOOD[2][:1]]),
        [GOOD[0], padded(GOOD[1][:4], 5), padded(GOOD[2][:1], 5)],
        "eof",
        1,
        {"short_lines": 2},
    ),
    "short last line": (
        source([GOOD[0], GOOD[1], GOOD[2][:2]]),
        [GOOD[0], GOOD[1], padded(GOOD[2][:2], 5)],
        "eof",
        2,
        {"short_lines": 1},
    ),
    "long line": (
        source([GOOD[0], line_of(1, 1, 8), GOOD[2]]),
        GOOD,
        "eof",
        1,
        {"long_lines": 1},
    ),
    "long last line": (
        source([GOOD[0], GOOD[1], line_of(1, 2, 6)]),
        GOOD,
        "end",
        2,
        {"long_lines": 1},
    ),
    "line without its end": (
        source(GOOD, marks={(4, 1): "none"}),
        GOOD[:2],
        "end",
        1,
        {"long_lines": 1},
    ),
    "long line, then a short one": (
        source([GOOD[0], line_of(1, 1, 7), GOOD[2][:2]]),
        [GOOD[0], GOOD[1], padded(GOOD[2][:2], 5)],
        "eof",
        1,
        {"long_lines": 1, "short_lines": 1},
    ),
    "no end of frame": (
        source(GOOD, eof=False),
        GOOD,
        "end",
        3,  # at the end item only
        {"early_starts": 1},
    ),
    "start inside a line": (
        source([GOOD[0], GOOD[1][:2]], eof=False, marks={(1, 1): "none"}),
        [GOOD[0], padded(GOOD[1][:2], 5)],
        "eof",
        1,
        {"early_starts": 1, "short_lines": 1},
    ),
    "start at a line's first pixel": (
        source(GOOD[:2], eof=False),
        GOOD[:2],
        "end",
        2,
        {"early_starts": 1},
    ),
    "start inside a first line": (
        source([GOOD[0][:1]], marks={(0, 0): "sof"}),
        [padded(GOOD[0][:1], MIN_WIDTH)],
        "eof",
        0,
        {"early_starts": 1, "short_lines": 1},
    ),
    "start in the cut part of a line": (
        source([GOOD[0], line_of(1, 1, 7)], marks={(6, 1): "none"}),
        GOOD[:2],
        "end",
        1,
        {"early_starts": 1, "long_lines": 1},
    ),
    "no start": (source(GOOD, marks={(0, 0): "none"}), None, "", None, {"missing_starts": 1}),
    "two frames without a start": (
        2 * source(GOOD, marks={(0, 0): "none"}),
        None,
        "",
        None,
        {"missing_starts": 1},
    ),
    "narrower than the support": (
        source(lines(1, MIN_WIDTH - 1, 3)),
        [padded(line, MIN_WIDTH) for line in lines(1, MIN_WIDTH - 1, 3)],
        "eof",
        0,
        {"short_lines": 3},
    ),
    "wider than the core": (
        source(lines(1, MAX_WIDTH + 3, 3)),
        lines(1, MAX_WIDTH, 3),
        "end",
        0,
        {"long_lines": 3},
    ),
    "wider than the core by one, one line": (
        source(lines(1, MAX_WIDTH + 1, 1)),
        lines(1, MAX_WIDTH, 1),
        "end",
        0,
        {"long_lines": 1},
    ),
}


@pytest.mark.parametrize("rates", RATES)
@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_mended_counted_and_marked(name: str, rates: tuple[float, float]) -> None:
    """The damaged frame comes between sound ones, which must not suffer."""
    sent, expected, end, first_damaged, status = DAMAGE[name]
    before, after, last = lines(8, 6, 2), lines(9, 5, 4), lines(10, 4, 2)
    result = guarded([*source(before), *sent, *source(after), *source(last)], rates)
    got = frames(result.payloads, CONFIG)
    assert result.status == status
    assert [f.lines for f in got] == [before, *([expected] if expected else []), after, last]
    sound = [got[0], *got[-2:]]
    assert [f.end for f in sound] == ["eof"] * 3
    assert not any(any(f.damaged) for f in sound)
    if expected and first_damaged is not None:
        assert got[1].end == end
        assert got[1].damaged[-1]
        marked = got[1].damaged.index(True) // len(expected[0])
        assert marked == first_damaged


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


@pytest.mark.parametrize("seed", range(12))
def test_anything_at_all_comes_out_as_whole_frames(seed: int) -> None:
    random = Random(seed)
    rates = RATES[seed % len(RATES)]
    likely = random.choice((0.02, 0.1, 0.4))
    noise = [
        pair(
            n,
            partner(n),
            sof=random.random() < likely,
            eol=random.random() < 0.25,
            eof=random.random() < likely,
        )
        for n in range(400)
    ]
    before, after, last = lines(8, 6, 2), lines(9, 5, 4), lines(10, 7, 2)
    result = guarded([*source(before), *noise, *source(after), *source(last)], rates, seed)
    got = frames(result.payloads, CONFIG)
    assert [f.lines for f in got[-2:]] == [after, last]
    assert not any(any(f.damaged) for f in got[-2:])
    assert got[0].lines == before
    kept = [value for f in got[1:-2] for line in f.lines for value in dict.fromkeys(line)]
    assert kept == sorted(set(kept)), "pixels were repeated beyond padding, or changed places"
    assert len(got) > 3
    assert result.status
