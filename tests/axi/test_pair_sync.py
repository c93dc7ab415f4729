"""PairSync: what leaves of two streams, whatever their marks and whenever their pixels come."""

from collections.abc import Sequence
from random import Random

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.axi.pair_sync import PairSync
from tests.support.broken_video import Stream, good_frame, numbered
from tests.support.fault_table import Sent
from tests.support.mutations import mutated
from tests.support.paired_video import Joined, Pair, broken_views, joined
from tests.support.simulation import config, sad, simulate

BITS = 16
SMALL = config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2, max_width=8, max_height=8)
PATIENCE = 30


def passed(
    left: Sequence[Sent],
    right: Sequence[Sent],
    *,
    skew: int,
    width: int = 0,
    rates: tuple[float, float, float] = (1, 1, 1),
    seed: int = 0,
    block: type[PairSync] = PairSync,
) -> Joined:
    """What leaves with pixels offered, and taken, at these rates; an offer stands until it is taken."""
    dut = block(BITS, skew=skew, most_pixels=SMALL.max_width * SMALL.max_height)
    random = Random(seed)
    pairs: list[Pair] = []
    losses = 0

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        nonlocal losses
        ctx.set(dut.by_count, width > 0)
        views, ports = (left, right), (dut.left, dut.right)
        at, offered = [0, 0], [False, False]
        waiting, quiet, reported, column = None, 0, 0, 0
        while quiet < PATIENCE:
            for k, port in enumerate(ports):
                if not offered[k] and at[k] < len(views[k]) and random.random() < rates[k]:
                    offered[k] = True
                    pixel = views[k][at[k]]
                    ctx.set(port.payload, {"pixel": pixel.value, "sof": pixel.sof, "last": pixel.eol})
                ctx.set(port.valid, offered[k])
            ready = random.random() < rates[2]
            ctx.set(dut.o.ready, ready)
            ctx.set(dut.between, column == 0)
            samples = (*(port.ready for port in ports), dut.o.valid, dut.o.payload, dut.lost)
            _, _, *taken, valid, payload, lost = await ctx.tick().sample(*samples)
            reported += lost
            if waiting is not None:
                assert valid, "what was offered was withdrawn"
                assert payload == waiting, "what was offered was altered"
            waiting = payload if valid and not ready else None
            quiet += 1
            for k in range(2):
                if offered[k] and taken[k]:
                    at[k], offered[k], quiet = at[k] + 1, False, 0
            if valid and ready:
                pairs.append(Pair(payload.left, payload.right, bool(payload.sof), bool(payload.last)))
                column = 1 if payload.sof else column + 1
                if column == width or (not width and payload.last):
                    column = 0
                quiet = 0
        losses = ctx.get(dut.losses)
        assert reported == losses

    simulate(dut, bench)
    return Joined(pairs, losses)


@pytest.mark.parametrize("seed", range(12))
def test_what_leaves_does_not_depend_on_time(seed: int) -> None:
    left, right = broken_views(seed, SMALL)
    width = 5 if seed % 4 == 3 else 0
    wanted = joined(left, right, skew=5, width=width)
    random = Random(seed)
    rates = (random.choice((1, 0.4)), random.choice((1, 0.4)), random.choice((1, 0.6)))
    assert passed(left, right, skew=5, width=width, rates=rates, seed=seed) == wanted


WIDTH, HEIGHT = 6, 4
GOOD = good_frame(WIDTH, HEIGHT, eof=False)


def lacks_start() -> Stream:
    return [GOOD[0]._replace(sof=False), *GOOD[1:]]


def starts_again(at: int) -> Stream:
    return [pixel._replace(sof=pixel.sof or k == at) for k, pixel in enumerate(GOOD)]


FAULTS: dict[str, tuple[Stream, int, int]] = {
    "a start that is missing": (lacks_start(), 1, 3),
    "a start in the first half": (starts_again(WIDTH), 2, 3),
    "a start in the second half": (starts_again(2 * WIDTH + 2), 2, 2),
    "a start in the last line": (starts_again(3 * WIDTH + 4), 2, 2),
    "a line's end that is missing": (
        [p._replace(eol=p.eol and k != 2 * WIDTH - 1) for k, p in enumerate(GOOD)],
        2,
        3,
    ),
    "an end too many": ([p._replace(eol=p.eol or k == WIDTH + 2) for k, p in enumerate(GOOD)], 2, 3),
    "a pixel that is missing": (GOOD[: WIDTH + 2] + GOOD[WIDTH + 3 :], 2, 3),
    "a pixel too many": ([*GOOD[: WIDTH + 2], Sent(0), *GOOD[WIDTH + 2 :]], 2, 3),
    "a line that is missing": (GOOD[:-WIDTH], 2, 3),
    "a line too many": (GOOD + [p._replace(sof=False) for p in GOOD[:WIDTH]], 2, 3),
}
"""The third of six frames, in one view; and how many of those before it, and behind it, are whole pairs."""


def _frames(stream: Stream) -> list[Stream]:
    """The two frames before the third one, and the three behind it."""
    size = len(GOOD)
    return [stream[:size], stream[size : 2 * size], *(stream[-k * size :][:size] for k in (3, 2, 1))]


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("name", FAULTS)
def test_the_frames_after_a_fault_are_pairs_of_their_own(name: str, side: int) -> None:
    """Not of one view's with the other's next. The frame with the fault has no proper end."""
    broken, before, behind = FAULTS[name]
    streams = [numbered(GOOD * 2 + (broken if k == side else GOOD) + GOOD * 3) for k in range(2)]
    found = passed(*streams, skew=WIDTH)
    frames: list[list[Pair]] = []
    for pair in found.pairs:
        if pair.sof:
            frames.append([])
        frames[-1].append(pair)
    own = [
        [Pair(a.value, b.value, a.sof, a.eol) for a, b in zip(*views, strict=True)]
        for views in zip(*map(_frames, streams), strict=True)
    ]
    assert frames[:before] == own[:before]
    assert frames[-behind:] == own[-behind:]
    # What lies between is found in mid-line by the start behind it.
    assert not any(frame[-1].last for frame in frames[before:-behind])
    assert found.losses >= 1


def test_a_pair_a_clock_and_a_view_that_is_silent() -> None:
    left = numbered(GOOD)
    assert passed(left, left[:7], skew=4).pairs == [Pair(p.value, p.value, p.sof, p.eol) for p in left[:7]]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("(left.payload.last == right.payload.last) | self.by_count", "1"),
        ("left.payload.last & right.payload.last", "left.payload.last"),
        ("m.Elif(both & self.between)", "m.Elif(both & ~self.between)"),
        ("view.ready.eq(self.o.ready & inside)", "view.ready.eq(self.o.ready)"),
        ("limit.eq(count >> 1)", "limit.eq(count >> 2)"),
        ("far & ~given_up", "far"),
        ("[ahead.eq(0), given_up.eq(0)]", "[ahead.eq(0)]"),
        ("[ahead.eq(0), given_up.eq(0)]", "[given_up.eq(0)]"),
        ("m.d.sync += whole.eq(0)", "pass"),
        ("ahead + within[0] - within[1]", "ahead + within[0]"),
        ("lost.eq(taken & ~agree)", "lost.eq(~agree)"),
    ],
)
def test_a_broken_one_is_found_out(old: str, new: str) -> None:
    block = mutated(PairSync, old, new)

    def check(seed: int) -> bool:
        left, right = broken_views(seed, SMALL)
        try:
            found = passed(left, right, skew=5, rates=(1, 0.5, 0.6), seed=seed, block=block)
        except AssertionError:
            return False
        return found == joined(left, right, skew=5)

    assert not all(map(check, range(24)))
