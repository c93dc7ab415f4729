"""Pause patterns come from their seed, and pause."""

from itertools import groupby, islice

import pytest

from softdepth.sim.stalls import Mode, Pauses, Stalls
from softdepth.spec.errors import ConfigError

CLOCKS = 50_000


def pattern(pauses: Pauses, clocks: int = CLOCKS) -> list[bool]:
    return list(islice(pauses.clocks(), clocks))


@pytest.mark.parametrize("mode", ["random", "bursts"])
def test_the_seed_alone_decides(mode: Mode) -> None:
    assert pattern(Pauses(mode, seed=3)) == pattern(Pauses(mode, seed=3))
    assert pattern(Pauses(mode, seed=3)) != pattern(Pauses(mode, seed=4))


@pytest.mark.parametrize("mode", ["random", "bursts"])
@pytest.mark.parametrize("probability", [0.1, 0.5, 0.9])
def test_pauses_the_share_asked_for(mode: Mode, probability: float) -> None:
    paused = pattern(Pauses(mode, probability=probability, burst=20, seed=1))
    assert sum(paused) / CLOCKS == pytest.approx(probability, abs=0.05)


def test_bursts_are_long_and_bounded() -> None:
    runs = [
        len(list(run)) for paused, run in groupby(pattern(Pauses("bursts", 0.2, burst=40, seed=1))) if paused
    ]
    assert 30 < sum(runs) / len(runs) < 60
    assert max(runs) > 60


@pytest.mark.parametrize("mode", ["none", "random", "bursts"])
def test_blocked_at_the_start(mode: Mode) -> None:
    initial = pattern(Pauses(mode, initial=300, seed=2), 1000)
    assert all(initial[:300])
    assert initial[300:] == pattern(Pauses(mode, seed=2), 700)


def test_none_never_pauses() -> None:
    assert not any(pattern(Pauses()))


def test_the_two_sides_are_independent() -> None:
    for stalls in (Stalls.random(0.5, seed=9), Stalls.bursts(0.5, seed=9)):
        assert pattern(stalls.input) != pattern(stalls.output)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"probability": 1.0}, "probability is 1.0"),
        ({"probability": -0.1}, "probability is -0.1"),
        ({"burst": 0}, "burst is 0"),
        ({"initial": -1}, "initial is -1"),
    ],
)
def test_refuses_what_would_never_end(fields: dict, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        Pauses("random", **fields)
