"""``softdepth run``: a stereo pair to depth, measured."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import ending, screen
from softdepth.cli import options, pairs
from softdepth.spec.config import Config

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.run.measure import Measurement


def run(
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
    from softdepth import files as results
    from softdepth.run import measure, report

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
    with results.result_folder(output, stale=report.FILES) as folder:
        measurement = measure.measure(pair, chosen, engine)
        summary = report.summarise(pair, chosen, measurement)
        report.write(folder, pair, chosen, measurement, summary)
    report.show(summary)
    print(f"results: {output}")
    fail_on_mismatch(pair, chosen, measurement)


def fail_on_mismatch(pair: "StereoPair", config: Config, measurement: "Measurement") -> None:
    """End the command with `ending.MISMATCH` where gateware and fixed model differ, and show where."""
    mismatches, gateware = measurement.mismatches(), measurement.gateware
    if not mismatches or gateware is None:
        return
    from softdepth.sim.stage import explain

    screen.note(f"error: gateware and fixed-point model differ in {len(mismatches)} pixels, first of them:")
    for line in explain(config, [(pair.left, pair.right)], [measurement.maps["fixed"]], [gateware]):
        screen.note(f"  {line}")
    raise typer.Exit(ending.MISMATCH)
