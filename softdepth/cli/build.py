"""``softdepth build``: a bitstream for a board."""

import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from softdepth import screen
from softdepth.cli import options
from softdepth.cli.bundle import bundled
from softdepth.files import refuse_to_replace
from softdepth.spec.boards import BOARDS, Board, find_board
from softdepth.spec.errors import InputError, ToolError

if TYPE_CHECKING:
    from softdepth.flow.bitstream import Manifest

BoardName = Annotated[str, typer.Option("--board", metavar="NAME", help=f"One of {', '.join(BOARDS)}.")]


@bundled
def build(
    board: BoardName,
    choice: options.Choice,
    seed: Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Where nextpnr starts from.")] = 1,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of the bitstream [default: out/BOARD]."),
    ] = None,
    program: Annotated[
        bool, typer.Option("--program", help="Load the bitstream into the board that is plugged in.")
    ] = False,
) -> None:
    """Build a board's bitstream: synthesis, place and route, packing.

    Without --preset or --config, the core is the one that docs/flow.md lists for the board.
    """
    chosen_board = find_board(board)
    chosen = choice.configuration(chosen_board.config)
    if program:
        _programmer(chosen_board)  # its absence is told before the minutes of a build
    folder = output or Path("out") / chosen_board.name
    from softdepth.flow import bitstream

    refuse_to_replace(folder, (*bitstream.FILES, bitstream.MANIFEST), filter(None, [choice.config]))
    manifest = bitstream.build(chosen_board, chosen, folder, seed=seed)
    _show(manifest)
    print(f"bitstream: {folder / manifest.bitstream}")
    if program:
        load(chosen_board, folder / manifest.bitstream)


def load(board: Board, bitstream: Path) -> None:
    """Load a bitstream into the board, by the board's own program."""
    if not bitstream.is_file():
        raise InputError(f"'{bitstream}' is not there", f"build it: make bitstream BOARD={board.name}")
    command = [_programmer(board), *(part.format(bitstream=bitstream) for part in board.program[1:])]
    done = subprocess.run(command, check=False)
    if done.returncode:
        raise ToolError(
            f"{board.program[0]} could not load the bitstream into the {board.name}",
            "check the cable, that you may use the USB device, and that this version of the program knows the"
            f" board: {board.program[0]} --list-boards",
        )


def _programmer(board: Board) -> str:
    found = shutil.which(board.program[0])
    if found is None:
        raise ToolError(
            f"'{board.program[0]}' is not on PATH, and loads bitstreams into the {board.name}",
            f"run: sudo apt install {board.program[0].lower()}",
        )
    return found


def _show(manifest: "Manifest") -> None:
    table = Table("", "", box=None, show_header=False, title=f"{manifest.board}, {manifest.device}")
    table.title_justify = "left"
    table.add_row("configuration", f"{manifest.config['name']} ({manifest.config_hash})")
    table.add_row("clock", f"{manifest.fmax_mhz:.1f} MHz reached, {manifest.wanted_mhz:.1f} wanted")
    table.add_row("slowest path", manifest.critical_path)
    for word, count in manifest.usage.items():
        share = 100 * count["used"] / max(count["available"], 1)
        table.add_row(word, f"{count['used']} of {count['available']} ({share:.0f} %)")
    table.add_row("seconds", ", ".join(f"{name} {taken:.0f}" for name, taken in manifest.seconds.items()))
    screen.console().print(table)
