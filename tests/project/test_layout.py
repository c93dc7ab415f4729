"""The folders keep to the project's rules."""

import subprocess
import sys
import tomllib
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.support.imports import ROOTS, graph, imported_names, modules, room

BASE = {"caches", "ending", "files", "processes", "screen", "sources", "templates", "softdepth"}
"""Modules of the package itself, and its name: what every program needs."""

PERMITTED: dict[str, set[str]] = {
    "spec": set(),
    "golden": {"spec", "files"},
    "hdl": {"spec"},
    "sim": {"golden", "hdl", "spec", "files"},
    "flow": {"hdl", "spec", *BASE},
    "export": {"golden", "hdl", "spec", "templates"},
    "rig": {"golden", "spec", "files"},
    "metric": {"rig", "golden", "spec", "files"},
    "ros": {"metric", "rig", "spec"},
    "inspect": {"golden", "spec"},
    "view": {"metric", "rig", "golden", "spec", "files", "templates"},
    "board": {"golden", "spec"},
    "run": {"board", "golden", "sim", "spec", *BASE},
    "sequence": {"board", "metric", "rig", "run", "golden", "sim", "spec", *BASE},
    "studies": {"export", "inspect", "run", "sequence", "sim", "flow", "golden", "hdl", "spec", *BASE},
    "caches": set(),
    "ending": {"caches", "spec", "softdepth"},
    "files": {"spec"},
    "processes": {"spec"},
    "screen": set(),
    "sources": {"spec"},
    "templates": set(),
}
"""What each room may import besides itself. The command line (``cli``) may import all."""

SOURCES = ("softdepth", "golden", "hdl", "sim", "tests", "examples")
MOST_LINES = 300
"""Of a file, so that each can be read at once."""


def departures(edges: dict[str, set[str]]) -> list[str]:
    """Imports between rooms that are not permitted."""
    return [
        f"{module} imports {each}"
        for module, targets in edges.items()
        for each in targets
        if (here := room(module)) not in ("cli", "__main__") and room(each) not in (here, "softdepth")
        if room(each) not in PERMITTED.get(here, set())
    ]


def test_the_rooms_import_what_they_may():
    edges = graph()
    assert len(edges) > 100
    assert departures(edges) == []


def test_every_room_has_its_rule():
    assert {room(module) for module in modules()} - {"cli", "__main__", "softdepth"} == PERMITTED.keys()


@pytest.mark.parametrize(
    ("module", "imported"),
    [
        ("softdepth.hdl.core", "softdepth.golden.fixed_model"),
        ("softdepth.golden.fixed_model", "softdepth.sim.frames"),
        ("softdepth.sim.build", "softdepth.flow.tools"),
        ("softdepth.flow.tools", "softdepth.sim.build"),
        ("softdepth.spec.config", "softdepth.files"),
        ("softdepth.run.report", "softdepth.cli.run"),
    ],
)
def test_a_forbidden_import_is_found(module, imported):
    edges = graph()
    assert {module, imported} <= edges.keys()
    edges[module] = {*edges[module], imported}
    assert departures(edges) == [f"{module} imports {imported}"]


def test_no_modules_import_each_other_in_a_circle():
    """Imports for type checking count too, but in `spec`: there the parts of a `Config` name it in types."""
    edges = graph(types=True) | {name: each for name, each in graph().items() if room(name) == "spec"}
    TopologicalSorter(edges).prepare()  # raises CycleError with the way round
    edges["softdepth.spec.errors"] = {"softdepth.cli.app"}
    with pytest.raises(CycleError):
        TopologicalSorter(edges).prepare()


def test_the_models_do_not_know_amaranth():
    for path in ROOTS["softdepth.golden"].rglob("*.py"):
        assert not any(name.partition(".")[0] == "amaranth" for name in imported_names(path)), path.name


@pytest.mark.parametrize(
    ("module", "spared"),
    [
        ("softdepth.flow.tools", {"cocotb", "cocotb_tools", "amaranth", "numpy"}),
        # every process of a sequence would wait for them, longer than for a small frame
        ("softdepth.sequence.work", {"matplotlib", "tifffile", "plotly", "amaranth", "cocotb"}),
    ],
)
def test_what_need_not_be_loaded_is_not(module, spared):
    script = f"import sys, {module}; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    assert "softdepth" in loaded
    assert not loaded & spared


def test_every_package_is_declared(project):
    tool = tomllib.loads((project / "pyproject.toml").read_text())["tool"]["setuptools"]
    declared = set(tool["packages"])
    found = set()
    for top, name in {
        "softdepth": "softdepth",
        **{f: f"softdepth.{f}" for f in ("golden", "hdl", "sim")},
    }.items():
        for init in (project / top).rglob("__init__.py"):
            inner = init.parent.relative_to(project / top).parts
            found.add(".".join([name, *inner]))
    assert declared == found


def too_long(folder: Path) -> list[str]:
    """The Python files in a folder, and in those inside it, that have more than `MOST_LINES`."""
    lengths = {path: len(path.read_text().splitlines()) for path in sorted(folder.rglob("*.py"))}
    return [f"{path}: {length} lines" for path, length in lengths.items() if length > MOST_LINES]


@pytest.mark.parametrize("folder", SOURCES)
def test_no_file_is_too_long(project, folder):
    assert too_long(project / folder) == []


def test_a_file_that_is_too_long_is_found(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "long.py").write_text("x = 1\n" * 301)
    (inner / "full.py").write_text("x = 1\n" * 300)
    assert too_long(tmp_path) == [f"{inner / 'long.py'}: 301 lines"]
