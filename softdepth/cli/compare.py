"""``softdepth compare``: how far the hardware is from the float model, and which widths are enough."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from softdepth.cli import options, pairs, run


def compare(
    left: pairs.Left = None,
    right: pairs.Right = None,
    dataset: pairs.Dataset = None,
    truth: pairs.GroundTruth = None,
    truth_scale: pairs.GroundTruthScale = None,
    bits: pairs.Bits = None,
    side_by_side: pairs.SideBySide = False,
    top_bottom: pairs.TopBottom = False,
    preset: options.Preset = None,
    config: options.ConfigFile = None,
    assignments: options.Assignments = None,
    lanes: options.Lanes = None,
    disparities: options.Disparities = None,
    operator: options.Operator = None,
    engine: Annotated[
        Literal["fixed", "rtl"],
        typer.Option("--engine", help="What stands for the hardware: its model, or the simulated gateware."),
    ] = "fixed",
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of tables, pictures and figures.")
    ] = Path("out/compare"),
) -> None:
    """Compare the hardware with the float model, and sweep its number formats."""
    chosen = options.configuration(
        preset, config, assignments, lanes=lanes, disparities=disparities, operator=operator
    )
    from softdepth import files as results
    from softdepth.run import measure
    from softdepth.studies.compare import comparison, sweep

    sweep.check_sweepable(chosen)
    pair = pairs.read(
        left,
        right,
        dataset,
        truth,
        truth_scale,
        chosen,
        bits=bits,
        side_by_side=side_by_side,
        top_bottom=top_bottom,
    )
    with results.result_folder(output, stale=comparison.FILES, last=comparison.LAST) as folder:
        measurement = measure.measure(pair, chosen, engine)
        found = comparison.compare(pair, chosen, measurement)
        comparison.write(folder, pair, chosen, measurement, found)
    comparison.show(found)
    print(f"results: {output}")
    run.fail_on_mismatch(pair, chosen, measurement)
