"""ItemQueue: items pass unchanged and in order, at full rate, with their places told."""

from random import Random
from typing import Any

import pytest

from softdepth.config import Config
from softdepth.hdl.frame_guard import item_layout
from softdepth.hdl.item_queue import ItemQueue

from .support import Transfers, config, sad, stream_through

CONFIGS = {
    "3x3": config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2),
    "far to the right": config(cost="sad", criteria=[sad(3, 5)], disparities=4, lanes=2),
    "far to the left": config(cost="sad", criteria=[sad(3, -4)], disparities=4, lanes=2),
    "nest": config(disparities=4, lanes=2),
}


def items(c: Config, count: int) -> list[dict[str, Any]]:
    """Lines of pixels that are all different, with markers and ends at random."""
    random = Random(count)
    width = c.min_width + 2
    return [
        {
            "left": k,
            "right": random.getrandbits(24),
            "x": k % width,
            **{name: random.getrandbits(1) for name in ("sof", "eol", "eof", "end", "damaged")},
        }
        for k in range(count)
    ]


def run(c: Config, sent: list[dict[str, Any]], **keys: Any) -> Transfers:
    packed = [item_layout(c).const(item).as_value().value for item in sent]
    return stream_through(ItemQueue(c), packed, **keys)


def check(c: Config, sent: list[dict[str, Any]], got: list[Any]) -> None:
    """Nothing lost, doubled, reordered or changed; the places are those of each pixel's ``x``."""
    assert [{name: o[name] for name in item_layout(c).members} for o in got] == sent
    support = c.reach_left + c.reach_right
    for item, o in zip(sent, got, strict=True):
        x = item["x"]
        places = (x == 0, x == c.reach_right, x >= support, x == support)
        assert (o.first, o.completes, o.inner, o.first_inner) == places, x


@pytest.mark.parametrize("name", CONFIGS)
@pytest.mark.parametrize(("i_rate", "o_rate"), [(1, 0.5), (0.5, 1), (0.6, 0.6), (0.2, 0.9), (0.9, 0.2)])
def test_any_stalls(name: str, i_rate: float, o_rate: float) -> None:
    c = CONFIGS[name]
    sent = items(c, 300)
    check(c, sent, run(c, sent, i_rate=i_rate, o_rate=o_rate, seed=len(name)).payloads)


@pytest.mark.parametrize("seed", range(20))
def test_bursts(seed: int) -> None:
    """Either side moves at a rate of its own, drawn anew for each run: full, empty and in between."""
    random = Random(seed)
    c = CONFIGS["3x3"]
    sent = items(c, 60)
    rates = {side: random.choice((1.0, 0.95, 0.5, 0.1)) for side in ("i_rate", "o_rate")}
    check(c, sent, run(c, sent, seed=seed, **rates).payloads)


def test_one_item_a_clock() -> None:
    c = CONFIGS["3x3"]
    sent = items(c, 50)
    result = run(c, sent)
    check(c, sent, result.payloads)
    assert result.taken == list(range(50))
    assert result.given == [clock + ItemQueue.latency for clock in result.taken]


def test_holds_two_and_refuses_the_third() -> None:
    """``ready`` is a register: it does not see in the same clock that the output is taken."""
    c = CONFIGS["3x3"]
    sent = items(c, 40)
    result = run(c, sent, o_rate=0.15, seed=2)
    held = [
        sum(t < clock for t in result.taken) - sum(t < clock for t in result.given)
        for clock in range(result.given[-1])
    ]
    assert max(held) == 2


@pytest.mark.parametrize("reset_at", [1, 2, 7])
def test_reset_empties_it(reset_at: int) -> None:
    c = CONFIGS["3x3"]
    sent = items(c, 30)
    result = run(c, sent, reset_at=reset_at, o_rate=0.3)
    check(c, sent[reset_at:], result.payloads[result.before_reset :])
