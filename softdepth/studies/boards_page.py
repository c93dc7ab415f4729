"""``python -m softdepth.studies.boards_page OUT``: the default cores of all boards, in docs/flow.md.

OUT holds a folder for each board, as `softdepth build` makes them. The figures of a board that has none there
stay as they are in docs/boards.json, provided that they are of the board's own core.
"""

import json
import sys
from collections.abc import Container, Iterable, Mapping
from pathlib import Path
from typing import Self

from pydantic import BaseModel

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.bitstream import MANIFEST, Manifest
from softdepth.flow.route import WORDS
from softdepth.spec.boards import BOARDS, Board
from softdepth.spec.errors import InputError
from softdepth.studies import markers
from softdepth.templates import render

DOCUMENT = Path("docs/flow.md")
JSON = Path("docs/boards.json")
PART = "boards"

RESOURCES = tuple(dict.fromkeys(WORDS.values()))
"""What a user counts, a column each; a family has most of them."""


class Core(BaseModel):
    """The part on a board and its default core, as far as the table shows them."""

    device: str
    preset: str
    disparities: int
    lanes: int
    width: int
    height: int

    @classmethod
    def of(cls, board: Board) -> Self:
        """A board's own."""
        config = board.config
        return cls(
            device=board.device,
            preset=config.name,
            disparities=config.disparities,
            lanes=config.lanes,
            width=config.max_width,
            height=config.max_height,
        )


class Usage(BaseModel):
    """How many of a resource a core takes, and how many the part has."""

    used: int
    available: int


class Row(BaseModel):
    """A row of the table: what a board's core takes of the part, and how fast it is.

    Members
    -------
    usage : by the words of `RESOURCES`, those that the family has.
    suffix : the bitstream's.
    """

    board: str
    core: Core
    usage: dict[str, Usage]
    wanted_mhz: float
    fmax_mhz: float
    suffix: str

    @classmethod
    def of(cls, board: Board, manifest: Manifest) -> Self:
        """That of a build of the board's own core."""
        usage: dict[str, Usage] = {}
        for word, resource in WORDS.items():
            if word in manifest.usage:
                usage.setdefault(resource, Usage.model_validate(manifest.usage[word]))
        return cls(
            board=board.name,
            core=Core.of(board),
            usage=usage,
            wanted_mhz=manifest.wanted_mhz,
            fmax_mhz=manifest.fmax_mhz,
            suffix=Path(manifest.bitstream).suffix,
        )

    @property
    def mpixel_s(self) -> float:
        """Million pixels a second at the board's clock."""
        return self.wanted_mhz * self.core.lanes / self.core.disparities


def page(rows: Iterable[Row]) -> str:
    """The table, a row a board."""
    return render("softdepth.studies", "boards.md", resources=RESOURCES, rows=rows)


def load(project: Path) -> dict[str, Row]:
    """By the board's name, the rows that are there of boards' own cores; those of earlier cores are out."""
    try:
        rows = [Row.model_validate(row) for row in json.loads((project / JSON).read_text())["rows"]]
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    return {row.board: row for row in rows if row.board in BOARDS and row.core == Core.of(BOARDS[row.board])}


def measured(folder: Path, kept: Container[str] = ()) -> dict[str, Row]:
    """The row of each board's build, by the board's name, except for missing ones whose rows are `kept`.

    Raises `InputError` if another is missing, or if one is for another core.
    """
    found: dict[str, Row] = {}
    for board in BOARDS.values():
        path = folder / board.name / MANIFEST
        if board.name in kept and not path.exists():
            continue
        remedy = f"run: make bitstream BOARD={board.name}"
        try:
            manifest = Manifest.model_validate_json(path.read_text())
        except (OSError, ValueError) as error:
            raise InputError(f"'{path}' cannot be read: {error}", remedy) from error
        if manifest.config_hash != board.config.hash:
            raise InputError(f"'{path}' is not for the {board.name}'s default core", remedy)
        found[board.name] = Row.of(board, manifest)
    return found


def write(project: Path, found: Mapping[str, Row]) -> None:
    """Write the rows into `project`: the table, and the file for `load`."""
    path = project / DOCUMENT
    try:
        text = path.read_text()
    except OSError as error:
        raise InputError(f"'{path}' cannot be read: {error}", "run this in the project's folder") from error
    rows = [found[name] for name in BOARDS]
    text = markers.renew(text, str(DOCUMENT), PART, page(rows))
    figures = {"rows": [row.model_dump() for row in rows]}
    write_atomically(project / JSON, (json.dumps(figures, indent=1) + "\n").encode())
    write_atomically(path, text.encode())


def main(folder: Path, project: Path) -> None:
    """Renew the table in `project` from the builds in `folder`."""
    kept = load(project)
    write(project, kept | measured(folder, kept))


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path(sys.argv[1]), Path.cwd())))
