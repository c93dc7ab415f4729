"""``softdepth bench``: speed of the simulated gateware, of the models, of sequences and of OpenCV."""

import json
from pathlib import Path
from typing import Annotated

import typer

from softdepth.spec.config import PRESETS, Config
from softdepth.spec.errors import InputError


def bench(
    dataset: Annotated[
        str, typer.Option("--dataset", metavar="NAME", help="The pair to run.")
    ] = "motorcycle",
    rows: Annotated[
        int, typer.Option("--rows", metavar="N", min=32, help="Rows of it that are simulated.")
    ] = 96,
    frames: Annotated[
        int, typer.Option("--frames", metavar="N", min=1, help="Frames of the sequence that is timed.")
    ] = 16,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of benchmarks.md and benchmarks.json."),
    ] = Path("docs"),
) -> None:
    """Measure speed and write it down, with the machine it was measured on."""
    from softdepth.files import write_atomically
    from softdepth.golden.data import datasets
    from softdepth.hdl.built import missing
    from softdepth.studies import benchmarks

    if not output.is_dir():
        raise InputError(f"folder '{output}' does not exist", "create it first, or choose another with -o")
    presets = [name for name in PRESETS if not missing(Config.preset(name))]
    figures = benchmarks.measured(datasets.load(dataset), rows, frames, presets)
    write_atomically(output / "benchmarks.json", (json.dumps(figures, indent=2) + "\n").encode())
    write_atomically(output / "benchmarks.md", benchmarks.page(figures).encode())
    print(f"results: {output / 'benchmarks.md'}, {output / 'benchmarks.json'}")
