"""``softdepth export``: a configured core as Verilog."""

from pathlib import Path
from typing import Annotated

import typer

from softdepth import screen
from softdepth.cli import options
from softdepth.cli.bundle import bundled
from softdepth.spec.errors import InputError

DESCRIPTION = ".json"
"""What the file that describes the core is called: as the Verilog file, with this for its suffix."""


@bundled
def export(
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Verilog file, beside which a .json describes the core; - is standard output.",
        ),
    ],
    choice: options.Choice,
    name: Annotated[
        str,
        typer.Option("--name", metavar="NAME", help="Module, and what all its modules' names begin with."),
    ] = "softdepth_core",
) -> None:
    """Write the core as one self-contained Verilog file."""
    chosen = choice.configuration()
    on_screen = str(output) == "-"
    from softdepth.export.core_file import check_export, export_core
    from softdepth.files import check_writable, is_replaced, refuse_to_replace, write_atomically

    description = output.with_suffix(DESCRIPTION) if not on_screen and is_replaced(output) else None
    if not on_screen:
        if output == description:
            raise InputError(f"'{output}' is named as the core's description", "name it core.v, or the like")
        for target in filter(None, (output, description)):
            check_writable(target)
            refuse_to_replace(target.parent, [target.name], filter(None, [choice.config]))
    check_export(chosen, name)
    exported = export_core(chosen, name)
    if on_screen:
        print(exported.verilog, end="")
        return
    if description is not None:
        write_atomically(description, exported.json.encode())
    write_atomically(output, exported.verilog.encode())
    beside = f"; described in {description}" if description else ""
    screen.note(f"{output}: module {name}, configuration {chosen.name} ({chosen.hash}){beside}")
