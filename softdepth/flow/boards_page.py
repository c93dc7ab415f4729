"""``python -m softdepth.flow.boards_page OUT``: the default cores of all boards, in docs/flow.md.

OUT holds a folder for each board, as `softdepth build` makes them.
"""

import sys
from pathlib import Path

from softdepth import markers
from softdepth.boards import BOARDS, Board
from softdepth.config import Config
from softdepth.errors import InputError, SoftdepthError
from softdepth.flow.bitstream import MANIFEST, Manifest
from softdepth.golden.writers import write_atomically

DOCUMENT = Path("docs/flow.md")
PART = "boards"

# nextpnr's words for each column; a family has one of them, or none.
_COLUMNS = {
    "LUT4": ("Total LUT4s", "LUT4"),
    "logic cells": ("ICESTORM_LC",),
    "flip-flops": ("Total DFFs", "DFF"),
    "block RAMs": ("DP16KD", "ICESTORM_RAM", "BSRAM"),
    "multipliers": ("MULT18X18D", "ICESTORM_DSP", "MULT18X18", "MULT9X9"),
}


def page(manifests: dict[Board, Manifest]) -> str:
    """The table: a row a board, with what its default core takes of the part and how fast it is."""
    lines = [
        "| board | part | core by default | largest image | "
        + " | ".join(_COLUMNS)
        + " | clock, MHz | reached | Mpixel/s | bitstream |",
        "|---|---|---|---|" + "---:|" * (len(_COLUMNS) + 3) + "---|",
    ]
    for board, manifest in manifests.items():
        config = Config.from_dict(manifest.config)
        used = (
            " + ".join(
                f"{manifest.usage[word]['used']:,} of {manifest.usage[word]['available']:,}"
                for word in words
                if word in manifest.usage
            )
            or "-"
            for words in _COLUMNS.values()
        )
        lines.append(
            f"| `{board.name}` | {board.device} | `{config.name}`, {config.disparities} disparities,"
            f" lanes = {config.lanes} | {config.max_width} x {config.max_height} | {' | '.join(used)}"
            f" | {manifest.wanted_mhz:.1f} | {manifest.fmax_mhz:.1f}"
            f" | {manifest.wanted_mhz / config.steps:.1f} | `{Path(manifest.bitstream).suffix}` |"
        )
    return "\n".join(lines)


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
    try:
        main(Path(sys.argv[1]), Path.cwd())
    except SoftdepthError as problem:
        sys.exit(f"error: {problem}")
