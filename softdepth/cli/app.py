"""The command line. `main` turns every problem of the user's into one line and an exit code."""

import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import Annotated

import typer
from typer.exceptions import TyperException

from softdepth import ending
from softdepth.cli import (
    bench,
    board,
    build,
    compare,
    evaluate,
    export,
    info,
    inspect,
    listing,
    options,
    paper,
    rectify,
    ros,
    run,
    sequence,
    utilization,
    view,
)
from softdepth.spec.errors import InputError

app = typer.Typer(
    name="softdepth",
    help="Stereo depth for FPGAs: run it, measure it, export it as Verilog.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
app.command("run")(run.run)
app.command("sequence")(sequence.sequence)
app.command("view")(view.view)
app.command("ros")(ros.ros)
app.command("inspect")(inspect.inspect)
app.command("rectify")(rectify.rectify)
app.command("board")(board.board)
app.command("compare")(compare.compare)
app.command("evaluate")(evaluate.evaluate)
app.command("export")(export.export)
app.command("build")(build.build)
app.command("utilization")(utilization.utilization)
app.command("info")(info.info)
app.command("presets")(listing.presets)
app.command("datasets")(listing.datasets)
app.command("bench")(bench.bench)
app.command("paper")(paper.paper)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"softdepth {version('softdepth')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _common(
    context: typer.Context,
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (default: the process's arguments) and return its exit code."""
    return ending.ended(lambda: _run(arguments))


def _run(arguments: Sequence[str] | None) -> int | None:
    options.arguments.set(tuple(sys.argv[1:] if arguments is None else arguments))
    try:
        return app(arguments, standalone_mode=False)
    except TyperException as error:
        raise InputError(error.format_message().rstrip("."), "see softdepth --help") from error
