"""ItemQueue: items pass unchanged and in order, one a clock, or one every other clock."""

from itertools import pairwise
from random import Random
from typing import Any

import pytest
from amaranth.lib import data

from softdepth.hdl.memory.item_queue import ItemQueue, places_for, waiting_time
from tests.support.simulation import Transfers, stream_through

LAYOUT = data.StructLayout({"number": 9, "noise": 24})


def items(count: int) -> list[dict[str, Any]]:
    """Items that are all different."""
    random = Random(count)
    return [{"number": k, "noise": random.getrandbits(24)} for k in range(count)]


def run(sent: list[dict[str, Any]], places: int, **keys: Any) -> Transfers:
    packed = [LAYOUT.const(item).as_value().value for item in sent]
    return stream_through(ItemQueue(LAYOUT, places=places), packed, **keys)


def check(sent: list[dict[str, Any]], got: list[Any]) -> None:
    """Nothing lost, doubled, reordered or changed."""
    assert [{name: o[name] for name in LAYOUT.members} for o in got] == sent


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize(("i_rate", "o_rate"), [(1, 0.5), (0.5, 1), (0.6, 0.6), (0.2, 0.9), (0.9, 0.2)])
def test_any_stalls(i_rate: float, o_rate: float, places: int) -> None:
    sent = items(300)
    check(sent, run(sent, places, i_rate=i_rate, o_rate=o_rate, seed=3).payloads)


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize("seed", range(20))
def test_bursts(seed: int, places: int) -> None:
    """Either side moves at a rate of its own, drawn anew for each run: full, empty and in between."""
    random = Random(seed)
    sent = items(60)
    rates = {side: random.choice((1.0, 0.95, 0.5, 0.1)) for side in ("i_rate", "o_rate")}
    check(sent, run(sent, places, seed=seed, **rates).payloads)


@pytest.mark.parametrize("places", [1, 2])
def test_one_item_a_clock_or_every_other(places: int) -> None:
    sent = items(50)
    result = run(sent, places)
    check(sent, result.payloads)
    assert result.taken == list(range(0, 50 * 2 // places, 2 // places))
    assert result.given == [clock + ItemQueue.latency for clock in result.taken]


@pytest.mark.parametrize("clocks", [1, 2, 5])
def test_places_are_enough(clocks: int) -> None:
    result = run(items(40), places_for(clocks), o_every=clocks)
    assert {b - a for a, b in pairwise(result.given)} == {clocks}


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize("clocks", [2, 3, 5])
def test_waiting_time(places: int, clocks: int) -> None:
    """Items are always on offer, and one leaves every so many clocks."""
    sent = items(40)
    result = run(sent, places, o_every=clocks)
    waits = [given - taken for taken, given in zip(result.taken, result.given, strict=True)]
    assert set(waits[places:]) == {ItemQueue.latency + waiting_time(places, clocks)}


@pytest.mark.parametrize("places", [1, 2])
def test_holds_so_many_and_refuses_the_next(places: int) -> None:
    """``ready`` is a register: it does not see in the same clock that the output is taken."""
    sent = items(40)
    result = run(sent, places, o_rate=0.15, seed=2)
    held = [
        sum(t < clock for t in result.taken) - sum(t < clock for t in result.given)
        for clock in range(result.given[-1])
    ]
    assert max(held) == places


@pytest.mark.parametrize("places", [1, 2])
@pytest.mark.parametrize("reset_at", [1, 2, 7])
def test_reset_empties_it(reset_at: int, places: int) -> None:
    sent = items(30)
    result = run(sent, places, reset_at=reset_at, o_rate=0.3)
    check(sent[reset_at:], result.payloads[result.before_reset :])
