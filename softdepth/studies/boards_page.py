"""``python -m softdepth.studies.boards_page OUT``: the default cores of all boards, in docs/flow.md.

OUT holds a folder for each board, as `softdepth build` makes them. If a board has none, its row stays as it
is, provided that it is for the board's own core.
"""

import sys
from collections.abc import Container, Mapping
from pathlib import Path

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.bitstream import MANIFEST, Manifest
from softdepth.flow.route import WORDS
from softdepth.spec.boards import BOARDS, Board
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies import markers
from softdepth.templates import render

DOCUMENT = Path("docs/flow.md")
PART = "boards"

RESOURCES = tuple(dict.fromkeys(WORDS.values()))
"""What a user counts, a column each; a family has most of them."""


def page(manifests: dict[Board, Manifest], kept: Mapping[str, str] | None = None) -> str:
    """The table: a row a board, with what its default core takes of the part and how fast it is.

    Rows of other boards, `kept` by the board's name, stand between them.
    """
    builds = []
    for board, manifest in manifests.items():
        builds.append(
            {
                "board": board,
                "manifest": manifest,
                "config": Config.from_dict(manifest.config),
                "core": _core(board, Config.from_dict(manifest.config)),
                "used": [_used(manifest, resource) for resource in RESOURCES],
                "suffix": Path(manifest.bitstream).suffix,
            }
        )
    head, line, *rows = render(
        "softdepth.studies", "boards.md", resources=RESOURCES, builds=builds
    ).splitlines()
    of = dict(kept or {}) | {row.split("`")[1]: row for row in rows}
    return "\n".join([head, line, *(of[name] for name in BOARDS if name in of)])


def _core(board: Board, config: Config) -> str:
    """The first cells of a board's row: which core its figures belong to."""
    core = f"`{config.name}`, {config.disparities} disparities, lanes = {config.lanes}"
    return f"| `{board.name}` | {board.device} | {core} | {config.max_width} x {config.max_height} |"


def _used(manifest: Manifest, resource: str) -> str:
    """How many of a resource the core takes, out of how many."""
    words = (word for word, name in WORDS.items() if name == resource and word in manifest.usage)
    count = manifest.usage.get(next(words, ""))
    return f"{count['used']:,} of {count['available']:,}" if count else "-"


def kept_rows(table: str) -> dict[str, str]:
    """The rows of a table that are for boards' own cores, by the board's name."""
    starts = {board.name: _core(board, board.config) for board in BOARDS.values()}
    return {
        name: row for row in table.splitlines() for name, start in starts.items() if row.startswith(start)
    }


def manifests(folder: Path, kept: Container[str] = ()) -> dict[Board, Manifest]:
    """The manifest of each board's build, except for missing ones whose rows are `kept`.

    Raises `InputError` if another is missing, or if one is for another core.
    """
    found: dict[Board, Manifest] = {}
    for board in BOARDS.values():
        if board.name in kept and not (folder / board.name / MANIFEST).exists():
            continue
        path = folder / board.name / MANIFEST
        remedy = f"run: make bitstream BOARD={board.name}"
        try:
            manifest = found[board] = Manifest.model_validate_json(path.read_text())
        except (OSError, ValueError) as error:
            raise InputError(f"'{path}' cannot be read: {error}", remedy) from error
        if manifest.config_hash != board.config.hash:
            raise InputError(f"'{path}' is not for the {board.name}'s default core", remedy)
    return found


def main(folder: Path, project: Path) -> None:
    """Renew the table in `project` from the builds in `folder`."""
    path = project / DOCUMENT
    try:
        text = path.read_text()
    except OSError as error:
        raise InputError(f"'{path}' cannot be read: {error}", "run this in the project's folder") from error
    kept = kept_rows(text)
    text = markers.renew(text, str(DOCUMENT), PART, page(manifests(folder, kept), kept))
    write_atomically(path, text.encode())


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path(sys.argv[1]), Path.cwd())))
