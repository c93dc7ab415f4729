"""Builds stay within their bound: the least recently used go, but none that may be about to run."""

import os
import time
from pathlib import Path

import pytest

from softdepth.sim import build_cache
from softdepth.sim.build_cache import RECENT_SECONDS, keep, locked, log_of, make_room

BYTES = 1000
OLD = 2 * RECENT_SECONDS


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache that holds three builds and a half."""
    monkeypatch.setattr(build_cache, "MAX_BYTES", 3 * BYTES + BYTES // 2)
    return tmp_path / "sim"


def make(place: Path, name: str, age: float) -> Path:
    """A build that was last used `age` seconds ago."""
    folder = place / name
    with locked(folder):
        program = place / "program"
        program.write_bytes(bytes(BYTES - 10))
        keep(folder, [program])
        program.unlink()
        log_of(folder).write_bytes(bytes(10))
    then = time.time() - age
    os.utime(folder.with_suffix(".lock"), (then, then))
    return folder


def left(place: Path) -> list[str]:
    return sorted(path.name for path in place.iterdir() if path.is_dir())


def test_the_least_recently_used_go(place: Path) -> None:
    for k, name in enumerate("abcde"):
        make(place, name, OLD + (k * 7) % 5)  # youngest to oldest: a, d, b, e, c
    make_room(place)
    assert left(place) == ["a", "b", "d"]
    assert sorted(path.name for path in place.iterdir() if path.is_file()) == sorted(
        f"{name}.{suffix}" for name in "abd" for suffix in ("lock", "log")
    )


def test_a_cache_within_its_bound_stays(place: Path) -> None:
    for name in "abc":
        make(place, name, OLD)
    make_room(place)
    assert left(place) == ["a", "b", "c"]


def test_using_a_build_makes_it_the_last_to_go(place: Path) -> None:
    for k, name in enumerate("abcd"):
        make(place, name, OLD - k)
    with locked(place / "a"):
        pass
    make_room(place)
    assert left(place) == ["a", "c", "d"]


def test_none_that_may_be_about_to_run_goes(place: Path) -> None:
    make(place, "old", OLD)
    for name in "abcde":
        make(place, name, RECENT_SECONDS / 2)
    make_room(place)
    assert left(place) == ["a", "b", "c", "d", "e"]


def test_none_that_is_locked_goes(place: Path) -> None:
    for k, name in enumerate("abcd"):
        make(place, name, OLD - k)
    then = time.time() - OLD
    with locked(place / "a"):
        os.utime(place / "a.lock", (then, then))  # as if its build took that long
        make_room(place)
    assert left(place) == ["a", "c", "d"]


def test_a_failed_builds_log_goes_too(place: Path) -> None:
    failed = make(place, "failed", OLD + 1)
    (failed / "program").unlink()
    failed.rmdir()
    log_of(failed).write_bytes(bytes(BYTES))
    for name in "abc":
        make(place, name, OLD)
    make_room(place)
    assert left(place) == ["a", "b", "c"]
    assert not list(place.glob("failed*"))
