"""What ``softdepth compare`` leaves: ``compare.json``, the files beside it, and the lines on the screen."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

from softdepth.run import report
from softdepth.run.measure import Measurement
from softdepth.spec.config import Config
from softdepth.studies.compare import tables
from softdepth.studies.compare.comparison import Comparison

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair

LAST = "compare.json"
FILES = ("compare.md", "differences.png", "sweep.png", "config.toml")
"""Everything that a comparison writes beside ``compare.json``."""


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
