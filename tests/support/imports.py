"""Who imports whom, read from the sources."""

import ast
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent.parent
ROOTS = {
    "softdepth.golden": PROJECT / "golden",
    "softdepth.hdl": PROJECT / "hdl",
    "softdepth.sim": PROJECT / "sim",
    "softdepth": PROJECT / "softdepth",
}
"""The packages' folders, the inner ones first."""


def modules() -> dict[str, Path]:
    """Every module of the project by its name."""
    found = {}
    for name, root in ROOTS.items():
        for path in root.rglob("*.py"):
            inner = path.relative_to(root).with_suffix("").parts
            found[".".join((name, *(part for part in inner if part != "__init__")))] = path
    return found


def imported_names(path: Path, *, types: bool = False) -> set[str]:
    """Every name that a file imports, dotted, in functions too; with `types`, for type checking too."""
    found: set[str] = set()
    waiting: list[ast.AST] = [ast.parse(path.read_text())]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        if types or not _for_types(node):
            waiting += ast.iter_child_nodes(node)
    return found


def _for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def graph(*, types: bool = False) -> dict[str, set[str]]:
    """For every module of the project, those that it imports."""
    known = modules()
    return {
        name: {each for each in imported_names(path, types=types) if each in known and each != name}
        for name, path in known.items()
    }


def room(module: str) -> str:
    """The part of the project that a module is in: the name behind ``softdepth``."""
    return [*module.split("."), "softdepth"][1]
