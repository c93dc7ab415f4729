"""The hash of sources changes with all that decides a result, and with nothing missed."""

import pytest

from softdepth import sources
from softdepth.sources import BUILDS_ON, covered, folder, sources_hash
from tests.support.imports import graph, modules

SHARED = {
    "__init__.py",
    "errors.py",
    "files.py",
    "markers.py",
    "processes.py",
    "screen.py",
    "sources.py",
    "templates.py",
}
"""Modules that decide no result: how errors read, where files and tables lie, who does the work."""


def test_further_files_count(tmp_path):
    file = tmp_path / "pins.lpf"
    file.write_text("1")
    before = sources_hash("flow", further=(file,))
    assert sources_hash("flow", further=(file,)) == before != sources_hash("flow")
    file.write_text("2")
    assert sources_hash("flow", further=(file,)) != before


@pytest.mark.parametrize("rooms", [*((room,) for room in BUILDS_ON), ("studies.paper", "sim")])
def test_a_room_covers_all_that_it_imports(rooms):
    """Directly or through other modules; what simulates is covered by whoever keeps what was simulated."""
    known = modules()
    names = {path: name for name, path in known.items()}
    edges = graph()
    places = [folder(each) for each in covered(*rooms)]
    waiting = [names[path] for room in rooms for path in folder(room).rglob("*.py")]
    seen: set[str] = set()
    while waiting:
        module = waiting.pop()
        if module not in seen and not (module.startswith("softdepth.sim") and "sim" not in covered(*rooms)):
            seen.add(module)
            waiting += edges[module]
    assert len(seen) > 5
    paths = [known[module] for module in seen]
    missed = {path.name for path in paths if not any(path.is_relative_to(each) for each in places)}
    assert missed <= SHARED


def test_an_edited_file_changes_the_rooms_that_build_on_it(tmp_path, monkeypatch):
    before = {room: sources_hash(room) for room in BUILDS_ON}
    edited = tmp_path / "hdl"
    edited.mkdir()
    (edited / "core.py").write_text("")
    original = sources.folder
    monkeypatch.setattr(sources, "folder", lambda room: edited if room == "hdl" else original(room))
    changed = {room for room in BUILDS_ON if sources_hash(room) != before[room]}
    assert changed == {room for room in BUILDS_ON if "hdl" in covered(room)}
