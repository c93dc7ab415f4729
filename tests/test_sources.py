"""The hash of sources changes with all that decides a result, and with nothing missed."""

import re
from pathlib import Path

import pytest

from softdepth import sources
from softdepth.sources import BUILDS_ON, PACKAGE, covered, folder, sources_hash

SHARED = {"errors.py", "files.py", "screen.py", "sources.py"}
"""Modules that decide no result: how errors read, and where files lie."""


def test_further_files_count(tmp_path):
    file = tmp_path / "pins.lpf"
    file.write_text("1")
    before = sources_hash("flow", further=(file,))
    assert sources_hash("flow", further=(file,)) == before != sources_hash("flow")
    file.write_text("2")
    assert sources_hash("flow", further=(file,)) != before


@pytest.mark.parametrize("room", ["golden", "hdl", "flow"])
def test_a_room_covers_all_that_it_imports(room):
    """Directly or through other modules of the package."""
    places = [folder(each) for each in covered(room)]
    waiting = list(folder(room).rglob("*.py"))
    seen: set[Path] = set()
    while waiting:
        file = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        waiting += imported(file)
    missed = {file for file in seen if not any(file.is_relative_to(place) for place in places)}
    assert {file.name for file in missed} <= SHARED


def imported(file: Path) -> list[Path]:
    """The modules of the project that a file imports anywhere in it."""
    found = []
    for name, names in re.findall(
        r"^ *from (softdepth[\w.]*) import ([^\n]*)", file.read_text(), re.MULTILINE
    ):
        for full in (name, *(f"{name}.{each.strip(' ()')}" for each in names.split(","))):
            parts = full.split(".")[1:]
            if not parts:
                continue
            top = folder(parts[0]) if parts[0] in ("golden", "hdl", "sim") else PACKAGE / parts[0]
            module = top.joinpath(*parts[1:]).with_suffix(".py")
            if module.is_file():
                found.append(module)
    return found


def test_an_edited_file_changes_the_rooms_that_build_on_it(tmp_path, monkeypatch):
    before = {room: sources_hash(room) for room in BUILDS_ON}
    edited = tmp_path / "hdl"
    edited.mkdir()
    (edited / "core.py").write_text("")
    original = sources.folder
    monkeypatch.setattr(sources, "folder", lambda room: edited if room == "hdl" else original(room))
    sources._rooms_hash.cache_clear()
    changed = {room for room in BUILDS_ON if sources_hash(room) != before[room]}
    sources._rooms_hash.cache_clear()
    assert changed == {room for room in BUILDS_ON if "hdl" in covered(room)}
