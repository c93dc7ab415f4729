"""The folders keep to the project's rules."""

import ast
import tomllib
from graphlib import TopologicalSorter
from pathlib import Path

import pytest


def imports(path: Path) -> set[str]:
    """Every module that a file imports, wherever in the file."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


@pytest.mark.parametrize(
    ("folder", "forbidden"),
    [("golden", {"hdl", "sim"}), ("hdl", {"golden", "sim"})],
)
def test_models_and_gateware_do_not_know_each_other(project, folder, forbidden):
    files = list((project / folder).rglob("*.py"))
    assert files
    for path in files:
        for name in imports(path):
            parts = name.split(".")
            assert not (parts[0] == "softdepth" and set(parts[1:2]) & forbidden), (
                f"{path.name} imports {name}"
            )
            assert not (parts[0] == "amaranth" and folder == "golden"), f"{path.name} imports {name}"


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


def test_models_import_in_one_direction(project):
    """No module of the models leads back to itself, in imports for type checking neither."""
    modules = {}
    for path in (project / "golden").rglob("*.py"):
        parts = path.relative_to(project / "golden").with_suffix("").parts
        modules[".".join(("softdepth", "golden", *(p for p in parts if p != "__init__")))] = path
    graph = {name: (imports(path) & modules.keys()) - {name} for name, path in modules.items()}
    order = list(TopologicalSorter(graph).static_order())  # raises CycleError with the way round
    assert order.index("softdepth.golden.data.truth") < order.index("softdepth.golden.data.images")
