"""What ``softdepth compare`` finds: ``compare.json``, the files beside it, and the lines on the screen.

``docs/compare.md`` documents every key.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from softdepth import screen
from softdepth.run import report
from softdepth.run.measure import Engine, Measurement
from softdepth.spec.config import Config
from softdepth.studies.compare import tables
from softdepth.studies.compare.agreement import Agreement, agreement
from softdepth.studies.compare.sweep import LABEL_BITS, Sweep, formats, sweep

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair

LAST = "compare.json"
FILES = ("compare.md", "differences.png", "sweep.png", "config.toml")
"""Everything that a comparison writes beside ``compare.json``."""


class Comparison(report.Report):
    """``compare.json``: a run's report, and how far its result is from the float model.

    Members
    -------
    agreement : the result's difference from the float model with the paper's label.
    sweep : the same for every number format.
    """

    agreement: Agreement
    sweep: Sweep


def compare(pair: "StereoPair", config: Config, measurement: Measurement) -> Comparison:
    """Compare a measured result with the float model, and sweep the number formats, showing progress.

    Raises `InputError` for images without a result.
    """
    paper = measurement.maps["float"]
    took = measurement.seconds
    screen.note(f"note: the number formats will take {screen.duration(estimate(config, took))} or so")
    found = agreement(measurement.result, paper, pair.truth)
    return Comparison(
        **report.summarise(pair, config, measurement).model_dump(),
        agreement=found,
        sweep=sweep(pair, config, paper),
    )


def estimate(config: Config, seconds: Mapping[Engine, float]) -> float:
    """How many seconds the sweep of `config` will take, from what the two models have taken."""
    return seconds["fixed"] * len(formats(config)) + seconds["float"] * len(LABEL_BITS)


def write(
    folder: Path, pair: "StereoPair", config: Config, measurement: Measurement, found: Comparison
) -> None:
    """Write the tables, the pictures, the configuration and ``compare.json`` into `folder`."""
    from softdepth.files import write_atomically
    from softdepth.studies.compare import pictures

    shown = pair.as_format("rgb8")
    reference = shown.right if config.reference == "right" else shown.left
    picture = pictures.differences(reference, measurement.result, measurement.maps["float"])
    write_atomically(folder / "differences.png", picture)
    marked = (config.membership_bits, tables.common_label(found))
    bad1 = found.metrics["float"].bad1
    write_atomically(
        folder / "sweep.png", pictures.sweep_plot(found.sweep, tables.title(found), bad1, marked)
    )
    (folder / "compare.md").write_text(tables.page(found))
    config.save(folder / "config.toml")
    (folder / LAST).write_text(json.dumps(found.model_dump(), indent=2) + "\n")


def show(found: Comparison) -> None:
    """Print the comparison as a user reads it."""
    report.show(found)
    print(tables.sentence(found))
    for line in tables.enough(found):
        print(line)
