"""``softdepth export``: a configured core as Verilog."""

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from softdepth import screen
from softdepth.cli import options
from softdepth.cli.bundle import bundled
from softdepth.spec.axi_options import SKEW_LINES, AxiOptions, Clocks, Inputs
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
    inputs: Annotated[
        Inputs | None, typer.Option("--inputs", help="Streams that bring the views, with --ip.")
    ] = None,
    skew: Annotated[
        int | None,
        typer.Option(
            "--skew",
            metavar="LINES",
            min=1,
            help=f"Of two inputs, by how many lines one may be ahead: {SKEW_LINES} unless set.",
        ),
    ] = None,
    clocks: Annotated[
        Clocks | None, typer.Option("--clocks", help="Of two inputs: the core's, or each its own.")
    ] = None,
    left: Annotated[
        bool, typer.Option("--left", help="With --ip: results carry their pixel of the left view.")
    ] = False,
) -> None:
    """Write the core as one self-contained Verilog file, or as a package for a design with AXI streams."""
    chosen = choice.configuration()
    asked = {"bus": bus, "inputs": inputs, "skew": skew, "clocks": clocks, "left": left or None}
    if ip is not None:
        _package(chosen, name, output, _options({k: v for k, v in asked.items() if v is not None}, chosen))
        return
    for option, value in asked.items():
        if value is not None:
            what = "has no registers" if option == "bus" else "has a stream of its own"
            text = option if value is True else f"{option} {value}"
            raise InputError(f"--{text} without --ip: the plain core {what}", "add --ip axi")
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


def _options(asked: dict[str, Any], config: Config) -> AxiOptions:
    """The ports that were asked for; raises `InputError` for what does not go together."""
    options = AxiOptions(**asked)
    for option in ("skew", "clocks"):
        if option in asked and not options.two:
            raise InputError(
                f"--{option} {asked[option]} is for two streams, but there is one", "add --inputs two"
            )
    if options.skew > config.max_height:
        raise InputError(
            f"--skew {options.skew} is more lines than a frame can have, {config.max_height}",
            "use a few: each takes a line of block RAM in each view",
        )
    return options


def _package(config: Config, name: str, output: Path, options: AxiOptions) -> None:
    """The core with AXI streams, as files in a folder."""
    from softdepth.export.axi_package import axi_package
    from softdepth.export.core_file import check_export
    from softdepth.files import result_folder

    if str(output) == "-":
        raise InputError("--ip writes a folder, and '-' is standard output", "name a folder with -o")
    check_export(config, name)
    with result_folder(output, last=f"{name}.core") as folder:
        for file, text in axi_package(config, name, options).items():
            (folder / file).write_text(text.rstrip("\n") + "\n")
    screen.note(f"{output}: module {name} with AXI streams, configuration {config.name} ({config.hash})")
