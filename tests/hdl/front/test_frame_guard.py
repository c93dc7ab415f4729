"""FrameGuard: sound frames pass, and every kind of damage comes out as whole frames."""

from itertools import chain
from random import Random

import pytest

from softdepth.hdl.front.frame_guard import FrameGuard
from tests.support.frames import Lines, frames, line_of, lines, padded, partner, source
from tests.support.guarded import CONFIG, MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH, RATES, guarded
from tests.support.simulation import config, pair, sad, stream_through

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
