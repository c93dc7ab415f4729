"""``softdepth run``: a stereo pair to depth, measured."""

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import screen
from softdepth.commands import options, pairs

if TYPE_CHECKING:
    from softdepth.measure import Measurement
    from softdepth.sim.compare import Mismatch

EXIT_MISMATCH = 1
SHOWN_MISMATCHES = 5


def run(
    left: pairs.Left = None,
    right: pairs.Right = None,
    dataset: pairs.Dataset = None,
    truth: pairs.GroundTruth = None,
    truth_scale: pairs.GroundTruthScale = None,
    preset: options.Preset = None,
    config: options.ConfigFile = None,
    assignments: options.Assignments = None,
    lanes: options.Lanes = None,
    disparities: options.Disparities = None,
    operator: options.Operator = None,
    engine: Annotated[
        Literal["rtl", "fixed", "float"],
        typer.Option("--engine", help="What computes the result: simulated gateware, or a model of it."),
    ] = "rtl",
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of pictures, maps and report.")
    ] = Path("out"),
) -> None:
    """Compute the depth of a stereo pair and report what it took."""
    chosen = options.configuration(
        preset, config, assignments, lanes=lanes, disparities=disparities, operator=operator
    )
    from softdepth import measure, report, results

    pair = pairs.read(left, right, dataset, truth, truth_scale, chosen)
    with results.result_folder(output, stale=report.FILES) as folder:
        measurement = measure.measure(pair, chosen, engine)
        summary = report.summarise(pair, chosen, measurement)
        report.write(folder, pair, chosen, measurement, summary)
    report.show(summary)
    print(f"results: {output}")
    fail_on_mismatch(measurement)


def fail_on_mismatch(measurement: "Measurement") -> None:
    """End the command with `EXIT_MISMATCH` where gateware and fixed model differ, and show where."""
    if mismatches := measurement.mismatches():
        _show(mismatches)
        raise typer.Exit(EXIT_MISMATCH)


def _show(mismatches: "list[Mismatch]") -> None:
    screen.note(f"error: gateware and fixed-point model differ in {len(mismatches)} pixels, first of them:")
    for mismatch in islice(mismatches, SHOWN_MISMATCHES):
        screen.note(f"  {mismatch}")
