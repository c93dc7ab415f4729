"""The properties that tests prove, and the part of docs/verification.md that lists them."""

import importlib
from dataclasses import dataclass, field
from pathlib import Path

from tests.support.claims import Claim

PART = "proofs"
DOCUMENT = Path("docs/verification.md")
PROOFS = ("tests/**/test_*proofs.py", "tests/**/test_ready_paths.py", "tests/**/test_stream_ends.py")


@dataclass
class Row:
    """A claim, the files whose tests prove it, and the faults that they refute it of."""

    claim: Claim
    files: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


def declared(project: Path) -> list[Row]:
    """Every claim that a test has, by the files' names. Fails where one is only proven, or only refuted."""
    rows: dict[Claim, Row] = {}
    for pattern in PROOFS:
        for file in sorted(project.glob(pattern)):
            name = file.relative_to(project).as_posix()
            module = importlib.import_module(name.removesuffix(".py").replace("/", "."))
            for test in vars(module).values():
                for mark in getattr(test, "pytestmark", []) if callable(test) else []:
                    if mark.name in ("proves", "refutes"):
                        row = rows.setdefault(mark.args[0], Row(mark.args[0]))
                        if mark.name == "refutes":
                            row.faults += _cases(test)
                        elif name not in row.files:
                            row.files.append(name)
    for row in rows.values():
        assert row.files, f"'{row.claim.what}' is never proven"
        assert row.faults, f"'{row.claim.what}' is never refuted"
    return list(rows.values())


def _cases(test: object) -> list[str]:
    """The faults by the names of a test's cases, or by its own."""
    marks = [mark for mark in getattr(test, "pytestmark", []) if mark.name == "parametrize"]
    cases = {mark.args[0]: mark.args[1] for mark in marks}
    for name in ("fault", "block", "name"):
        if name in cases:
            return [str(getattr(case, "id", case)) for case in cases[name]]
    own = getattr(test, "__name__", "").removeprefix("test_")
    return [own.removesuffix("_is_refuted").removesuffix("_are_refuted").replace("_", " ")]


def table(rows: list[Row]) -> str:
    """What is proven, as the document shows it."""
    lines = ["| what | of what | depth | refuted of a block where | test |", "|---|---|---|---|---|"]
    for row in rows:
        claim = row.claim
        tests = ", ".join(f"`{file}`" for file in row.files)
        lines.append(f"| {claim.what} | {claim.sizes} | {claim.depth} | {'; '.join(row.faults)} | {tests} |")
    return "\n".join(lines)
