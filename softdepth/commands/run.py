"""``softdepth run``: a stereo pair to depth, measured."""

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import screen
from softdepth.commands import options
from softdepth.config import Config
from softdepth.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.images import StereoPair
    from softdepth.sim.compare import Mismatch

EXIT_MISMATCH = 1
SHOWN_MISMATCHES = 5


def run(
    left: Annotated[Path | None, typer.Argument(metavar="LEFT", help="Left image, rectified.")] = None,
    right: Annotated[Path | None, typer.Argument(metavar="RIGHT", help="Right image, rectified.")] = None,
    dataset: Annotated[
        str | None, typer.Option("--dataset", metavar="NAME", help="A known pair; see softdepth datasets.")
    ] = None,
    truth: Annotated[
        Path | None,
        typer.Option("--gt", metavar="FILE", help="Known disparity of the reference view: PFM or gray PNG."),
    ] = None,
    truth_scale: Annotated[
        float | None,
        typer.Option("--gt-scale", metavar="N", help="File units per pixel of disparity."),
    ] = None,
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

    pair = _read(left, right, dataset, truth, truth_scale, chosen)
    measure.check_fits(pair, chosen)
    for text in pair.notes:
        screen.note(f"note: {text}")
    with results.result_folder(output, stale=report.FILES) as folder:
        measurement = measure.measure(pair, chosen, engine)
        summary = report.summarise(pair, chosen, measurement)
        report.write(folder, pair, chosen, measurement, summary)
    report.show(summary)
    print(f"results: {output}")
    if mismatches := measurement.mismatches():
        _show(mismatches)
        raise typer.Exit(EXIT_MISMATCH)


def _read(
    left: Path | None,
    right: Path | None,
    dataset: str | None,
    truth: Path | None,
    scale: float | None,
    config: Config,
) -> "StereoPair":
    from dataclasses import replace

    if scale is not None and truth is None:
        raise InputError(f"--gt-scale {scale:g} without --gt", "name the ground truth it belongs to")
    if dataset is not None:
        if left or truth:
            raise InputError(
                f"--dataset {dataset} brings its own images and truth", "leave the files out, or --dataset"
            )
        from softdepth.golden import datasets

        return datasets.load(dataset, reference=config.reference)
    if left is None or right is None:
        raise InputError(
            f"a pair is two images, {1 if left else 0} given",
            "use softdepth run LEFT RIGHT, or --dataset NAME",
        )
    from softdepth.golden.images import read_pair
    from softdepth.golden.truth import read_truth

    pair = read_pair(left, right)
    if truth is None:
        return pair
    shape = (pair.height, pair.width)
    return replace(pair, truth=read_truth(truth, scale=scale, shape=shape, view=config.reference))


def _show(mismatches: "list[Mismatch]") -> None:
    screen.note(f"error: gateware and fixed-point model differ in {len(mismatches)} pixels, first of them:")
    for mismatch in islice(mismatches, SHOWN_MISMATCHES):
        screen.note(f"  {mismatch}")
