"""Builds are cached by everything that matters, and a failed one leaves nothing behind."""

import errno
import os
import shutil
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from unittest.mock import ANY
from uuid import uuid4

import pytest

from softdepth.sim.build import TOP, build
from softdepth.sim.build_cache import locked
from softdepth.sim.toolchain import find_toolchain
from softdepth.spec.errors import ToolError


@pytest.fixture
def new_design(stand_in: Callable[..., str]) -> Iterator[str]:
    """A design that was never built before, removed from the cache afterwards."""
    text = f"// {uuid4()}\n{stand_in()}"
    yield text
    folder = build(text).folder
    shutil.rmtree(folder)
    for suffix in (".log", ".lock"):
        folder.with_suffix(suffix).unlink()


@pytest.fixture
def quick_tools(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs in place of Verilator and make, which leave a program without compiling anything."""
    scripts = {"verilator": "mkdir -p obj", "make": f"touch obj/{TOP} obj/verilated.o"}
    for name, script in scripts.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{script}\n")
        (tmp_path / name).chmod(0o755)
    tools = replace(find_toolchain(), verilator=tmp_path / "verilator", make=tmp_path / "make")
    monkeypatch.setattr("softdepth.sim.build.find_toolchain", lambda: tools)
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path / "cache"))


def test_builds_once_even_when_asked_twice_at_the_same_time(new_design: str) -> None:
    with ProcessPoolExecutor(2) as pool:
        first, second = pool.map(build, [new_design] * 2)
    assert {first.cached, second.cached} == {True, False}
    assert first.folder == second.folder
    third = build(new_design)
    assert third.cached
    assert third.seconds < 2
    assert (third.folder / TOP).stat().st_mode & 0o100


def test_another_design_or_flag_is_another_build(
    quick_tools: None, stand_in: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    one = build(stand_in())
    assert build(stand_in()) == replace(one, cached=True, seconds=ANY)
    assert build(stand_in("hangs")).folder != one.folder
    monkeypatch.setattr("softdepth.sim.build.MAKE_FLAGS", ("OPT_FAST=-O0", "OPT_SLOW=-O0", "OPT_GLOBAL=-O0"))
    other = build(stand_in())
    assert other.folder != one.folder
    assert not other.cached


@pytest.mark.parametrize(
    "text",
    [
        "module softdepth_core(input clk; endmodule",
        "module other(input clk); endmodule",
        "module softdepth_core(input clk); missing m(clk); endmodule",
    ],
    ids=["syntax", "no top", "missing module"],
)
def test_a_broken_design_fails_every_time(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path / "with space"))
    for _ in range(2):
        with pytest.raises(ToolError, match="%Error") as caught:
            build(text)
        assert "\n" not in str(caught.value)
        log = Path(caught.value.remedy.removeprefix("see "))
        assert log.is_relative_to(tmp_path)
        assert "%Error" in log.read_text()
        assert not [path for path in (tmp_path / "with space").rglob("*") if path.name == TOP]


def test_a_compiler_that_fails_leaves_no_program(
    stand_in: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path))
    monkeypatch.setattr("softdepth.sim.build.MAKE_FLAGS", ("OPT_FAST=--no-such-option",))
    with pytest.raises(ToolError, match=r"no-such-option.*see "):
        build(stand_in())
    assert not list(tmp_path.rglob(TOP))
    assert not list(tmp_path.rglob("*.o"))


def test_a_cache_that_cannot_be_written(
    stand_in: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path / "file"))
    with pytest.raises(ToolError, match=r"cannot write the cache.*set SOFTDEPTH_CACHE"):
        build(stand_in())


@pytest.mark.parametrize("written", ["copy2", "copyfile"], ids=["the result", "what is reused"])
def test_a_full_disk_is_told_in_a_line(
    quick_tools: None,
    stand_in: Callable[..., str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    written: str,
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    build(stand_in())  # Verilator's own library is kept from now on
    monkeypatch.setattr(shutil, written, full)
    with pytest.raises(ToolError, match=r"kept in '.*no space left on device; make room") as error:
        build(f"// another\n{stand_in()}")
    assert str(tmp_path) in str(error.value)
    assert len(str(error.value).splitlines()) == 1
    assert not list(tmp_path.rglob(".part-*"))
    assert len(list(tmp_path.rglob(TOP))) == 1


def test_a_full_disk_that_no_program_tells(
    stand_in: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Verilator leaves empty files, of which make says that they have no targets."""
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path))
    monkeypatch.setattr("softdepth.sim.build.MAKE_FLAGS", ("OPT_FAST=--no-such-option",))
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=0))
    with pytest.raises(ToolError, match="no space left on device; make room"):
        build(stand_in())


def test_a_new_build_makes_room_for_itself(
    stand_in: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The oldest build goes for it; what is merely taken from the cache costs none its place."""
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path))
    monkeypatch.setattr("softdepth.sim.build_cache.MAX_BYTES", 1)
    place = tmp_path / "sim"
    for name in ("first", "second"):
        with locked(place / name):
            (place / name).mkdir()
            (place / name / TOP).write_bytes(bytes(9))
        os.utime(place / f"{name}.lock", (0, 1))
    new = build(stand_in()).folder
    assert [path for path in place.iterdir() if path.is_dir()] == [new]
    with locked(place / "first"):
        (place / "first").mkdir()
    os.utime(place / "first.lock", (0, 1))
    assert build(stand_in()).cached
    assert (place / "first").exists()
