"""What ``softdepth compare`` finds: ``compare.json``, of which ``docs/compare.md`` documents every key."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from softdepth import screen
from softdepth.run import report
from softdepth.run.measure import Engine, Measurement
from softdepth.spec.config import Config
from softdepth.studies.compare.agreement import Agreement, agreement
from softdepth.studies.compare.sweep import LABEL_BITS, Sweep, formats, sweep

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair


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
