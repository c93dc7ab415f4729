"""``softdepth run``: a stereo pair to depth, measured."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import ending, screen
from softdepth.cli import calibrations, inspect, metres, options, pairs
from softdepth.cli.bundle import bundled
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.run.measure import Engine, Measurement

ADDED: "tuple[Engine, ...]" = ("fixed", "float", "paper", "sad")
"""What a result can be compared with."""

Also = Annotated[
    str | None,
    typer.Option(
        "--also",
        metavar="LIST",
        help="Compute these as well, e.g. float,sad [default: float,sad with rtl, none with a model].",
    ),
]


@bundled
def run(
    source: pairs.Source,
    choice: options.Choice,
    cameras: metres.Cameras,
    raw: calibrations.Raw,
    kept: metres.Kept,
    engine: Annotated[
        Literal["rtl", "fixed", "float"],
        typer.Option("--engine", help="What computes the result: simulated gateware, or a model of it."),
    ] = "rtl",
    also: Also = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of pictures, maps and report.")
    ] = Path("out"),
) -> None:
    """Compute the depth of a stereo pair and report what it took."""
    further = compared(also)
    kept.choice()
    from softdepth import files as results
    from softdepth.run import measure, report

    raw.check(source.dataset, output)
    left = calibrations.stale(output, cameras.calibration or [])
    stale = (*report.FILES, *metres.FILES, *left)
    source.keep_safe(
        output, (*stale, results.LAST), choice.config, *(raw.rectify or ()), *(cameras.calibration or ())
    )
    pair, chosen = source.read_for(choice)
    pair, geometry, rectifier = metres.prepare(pair, cameras, raw)
    kept.check(chosen, geometry is not None)
    inspect.note(pair, chosen)
    with results.result_folder(output, stale=stale) as folder:
        measurement = measure.measure(pair, chosen, engine, also=further)
        summary = report.summarise(pair, chosen, measurement)
        report.write(folder, pair, chosen, measurement, summary)
        if geometry is not None:
            metres.write(folder, measurement.result, geometry, kept, pair, chosen)
        if rectifier is not None:
            calibrations.write(folder, rectifier, pair)
    report.show(summary)
    print(f"results: {output}")
    fail_on_mismatch(pair, chosen, measurement)


def compared(also: str | None) -> "tuple[Engine, ...] | None":
    """The engines that ``--also`` lists, or None where it is left out; raises `InputError` for others."""
    if also is None:
        return None
    found: list[Engine] = []
    for name in filter(None, also.split(",")):
        known: list[Engine] = [each for each in ADDED if each == name.strip()]
        if not known:
            raise InputError(f"--also {also} names '{name}'", f"use some of {', '.join(ADDED)}")
        found += known
    return tuple(found)


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
