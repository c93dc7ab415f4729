"""A small core, synthesised once for all tests that look at its netlist."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from softdepth.cli.app import main
from softdepth.flow import tools
from softdepth.flow.synthesis import Netlist, core_netlist
from softdepth.spec.config import Config

SMALL = Config.preset("lite").override(["disparities=8", "lanes=2", "max_width=64", "max_height=64"])
"""Two lanes with every kind of block: three criteria, fuzzy inference, comparisons by multiplier."""


@pytest.fixture(scope="session")
def small_netlist() -> Netlist:
    """The ECP5 netlist of `SMALL`, as a bitstream would hold it. Change copies of it only."""
    return core_netlist(SMALL)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache of the test's own."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(folder))
    return folder


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cache: Path) -> Iterator[Callable[..., Path]]:
    """PATH holds programs that the test makes, and no others: `path(name, script)`."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))
    tools.find_tool.cache_clear()

    def program(name: str, script: str) -> Path:
        file = folder / name
        file.write_text(f"#!/bin/sh\n{script}\n")
        file.chmod(0o755)
        return file

    yield program
    tools.find_tool.cache_clear()


@pytest.fixture
def refused(capfd: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Run a command that must fail with one line, and give that line."""

    def command(*arguments: object) -> str:
        capfd.readouterr()
        assert main([str(argument) for argument in arguments]) == 2
        lines = [line for line in capfd.readouterr().err.splitlines() if line.startswith("error: ")]
        assert len(lines) == 1
        assert "; " in lines[0], f"no remedy in '{lines[0]}'"
        return lines[0]

    return command
