"""``softdepth export``: a configured core as Verilog."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from softdepth import screen
from softdepth.cli import options
from softdepth.cli.bundle import bundled
from softdepth.spec.bus import Bus
from softdepth.spec.config import Config
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
            help="Verilog file, beside which a .json describes the core; - is standard output. With --ip, a"
            " folder.",
        ),
    ],
    choice: options.Choice,
    name: Annotated[
        str,
        typer.Option("--name", metavar="NAME", help="Module, and what all its modules' names begin with."),
    ] = "softdepth_core",
    ip: Annotated[
        Literal["axi"] | None,
        typer.Option("--ip", help="A package with AXI4-Stream Video and registers: docs/axi.md."),
    ] = None,
    bus: Annotated[Bus | None, typer.Option("--bus", help="Of the registers, with --ip.")] = None,
) -> None:
    """Write the core as one self-contained Verilog file, or as a package for a design with AXI streams."""
    chosen = choice.configuration()
    if ip is None and bus is not None:
        raise InputError(f"--bus {bus} without --ip: the plain core has no registers", "add --ip axi")
    if ip is not None:
        _package(chosen, name, output, bus or "axi-lite")
        return
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


def _package(config: Config, name: str, output: Path, bus: Bus) -> None:
    """The core with AXI streams, as files in a folder."""
    from softdepth.export.axi_package import axi_package
    from softdepth.export.core_file import check_export
    from softdepth.files import result_folder

    if str(output) == "-":
        raise InputError("--ip writes a folder, and '-' is standard output", "name a folder with -o")
    check_export(config, name)
    with result_folder(output, last=f"{name}.core") as folder:
        for file, text in axi_package(config, name, bus).items():
            (folder / file).write_text(text.rstrip("\n") + "\n")
    screen.note(f"{output}: module {name} with AXI streams, configuration {config.name} ({config.hash})")
