"""``python -m softdepth.studies.boards_page OUT``: the default cores of all boards, in docs/flow.md.

OUT holds a folder for each board, as `softdepth build` makes them.
"""

import sys
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


def page(manifests: dict[Board, Manifest]) -> str:
    """The table: a row a board, with what its default core takes of the part and how fast it is."""
    builds = []
    for board, manifest in manifests.items():
        builds.append(
            {
                "board": board,
                "manifest": manifest,
                "config": Config.from_dict(manifest.config),
                "used": [_used(manifest, resource) for resource in RESOURCES],
                "suffix": Path(manifest.bitstream).suffix,
            }
        )
    return render("softdepth.studies", "boards.md", resources=RESOURCES, builds=builds)


def _used(manifest: Manifest, resource: str) -> str:
    """How many of a resource the core takes, and of how many."""
    words = (word for word, name in WORDS.items() if name == resource and word in manifest.usage)
    count = manifest.usage.get(next(words, ""))
    return f"{count['used']:,} of {count['available']:,}" if count else "-"


def manifests(folder: Path) -> dict[Board, Manifest]:
    """The manifest of each board's build; raises `InputError` where one is missing or of another core."""
    found: dict[Board, Manifest] = {}
    for board in BOARDS.values():
        path = folder / board.name / MANIFEST
        remedy = f"run: make bitstream BOARD={board.name}"
        try:
            manifest = found[board] = Manifest.model_validate_json(path.read_text())
        except (OSError, ValueError) as error:
            raise InputError(f"'{path}' cannot be read: {error}", remedy) from error
        if manifest.config_hash != board.config.hash:
            raise InputError(f"'{path}' is not of the core that is the {board.name}'s by default", remedy)
    return found


def main(folder: Path, project: Path) -> None:
    """Renew the table in `project` from the builds in `folder`."""
    path = project / DOCUMENT
    try:
        text = path.read_text()
    except OSError as error:
        raise InputError(f"'{path}' cannot be read: {error}", "run this in the project's folder") from error
    text = markers.renew(text, str(DOCUMENT), PART, page(manifests(folder)))
    write_atomically(path, text.encode())


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path(sys.argv[1]), Path.cwd())))
