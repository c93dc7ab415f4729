"""``softdepth compare``: how far the hardware is from the float model, and which widths are enough."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from softdepth.cli import options, pairs, run
from softdepth.cli.bundle import bundled


@bundled
def compare(
    source: pairs.Source,
    choice: options.Choice,
    engine: Annotated[
        Literal["fixed", "rtl"],
        typer.Option("--engine", help="What stands for the hardware: its model, or the simulated gateware."),
    ] = "fixed",
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of tables, pictures and figures.")
    ] = Path("out/compare"),
) -> None:
    """Compare the hardware with the float model, and sweep its number formats."""
    sweepable = choice.configuration()
    from softdepth.files import result_folder
    from softdepth.run import measure
    from softdepth.studies.compare import comparison, sweep
    from softdepth.studies.compare import output as results

    sweep.check_sweepable(sweepable)
    source.keep_safe(output, (*results.FILES, results.LAST), choice.config)
    pair, chosen = source.read_for(choice)
    with result_folder(output, stale=results.FILES, last=results.LAST) as folder:
        measurement = measure.measure(pair, chosen, engine, also=measure.COMPARED)
        found = comparison.compare(pair, chosen, measurement)
        results.write(folder, pair, chosen, measurement, found)
    results.show(found)
    print(f"results: {output}")
    run.fail_on_mismatch(pair, chosen, measurement)
