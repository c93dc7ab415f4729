"""The report of a run: ``report.json``, the files beside it, and the table on the screen.

``docs/report.md`` documents every key. Keys are only ever added; a change of meaning raises `SCHEMA`.
"""

import json
import platform
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from pydantic import BaseModel
from rich.table import Table

from softdepth import screen
from softdepth.files import write_atomically
from softdepth.run.measure import Engine, Measurement
from softdepth.spec.config import Config

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.golden.data.truth import Truth
    from softdepth.golden.maps import DisparityMap

SCHEMA = 1
ENGINES: tuple[Engine, ...] = get_args(Engine)
FILES = (
    "disparity.png",
    "disparity.pfm",
    "colour.png",
    "code.png",
    "overview.png",
    "error.png",
    "config.toml",
)
"""Everything that a run may write beside ``report.json``."""


class Accuracy(BaseModel):
    """One engine's scores; all None where it was not measured, and all but `density` without a truth."""

    bad1: float | None = None
    bad2: float | None = None
    mae: float | None = None
    rmse: float | None = None
    nonocc_bad1: float | None = None
    nonocc_bad2: float | None = None
    nonocc_mae: float | None = None
    nonocc_rmse: float | None = None
    measured_bad1: float | None = None
    measured_bad2: float | None = None
    measured_mae: float | None = None
    measured_rmse: float | None = None
    paper_rmse: float | None = None
    density: float | None = None


class Scored(BaseModel):
    """What the scores are over; see `softdepth.golden.score.metrics.Coverage`."""

    scored: int
    scored_percent: float
    outside: int
    outside_percent: float
    first: int
    last: int


class Report(BaseModel):
    """``report.json``. None means that the chosen engine does not measure it."""

    schema_version: int = SCHEMA
    engine: str
    pair: str
    width: int
    height: int
    pixels: int
    notes: list[str]
    rtl_mismatches: int | None
    cycles_per_pixel: float | None
    sim_pixels_per_second: float | None
    link: dict[str, int] | None = None
    seconds: dict[Engine, float | None]
    metrics: dict[Engine, Accuracy]
    truth: Scored | None = None
    config: dict[str, Any]
    config_hash: str
    tools: dict[str, str | None]


def summarise(pair: "StereoPair", config: Config, measurement: Measurement) -> Report:
    """Score every measured map, and gather what was measured."""
    metrics: dict[Engine, Accuracy] = {engine: Accuracy() for engine in ENGINES}
    for engine, found in measurement.maps.items():
        metrics[engine] = accuracy(found, pair.truth)
    mismatches = measurement.mismatches()
    return Report(
        engine=measurement.engine,
        pair=pair.name,
        width=pair.width,
        height=pair.height,
        pixels=pair.width * pair.height,
        notes=list(pair.notes),
        rtl_mismatches=None if mismatches is None else len(mismatches),
        cycles_per_pixel=measurement.cycles_per_pixel,
        sim_pixels_per_second=measurement.pixels_per_second,
        link=measurement.link,
        seconds={engine: measurement.seconds.get(engine) for engine in ENGINES},
        metrics=metrics,
        truth=scored(pair.truth, config),
        config=config.model_dump(mode="json"),
        config_hash=config.hash,
        tools=_tools("rtl" in measurement.maps),
    )


def accuracy(found: "DisparityMap", truth: "Truth | None") -> Accuracy:
    """The scores of a map; without a truth, only the density."""
    from softdepth.golden.score.metrics import density, evaluate

    if truth is None:
        return Accuracy(density=density(found.valid))
    scores = evaluate(found.pixels, truth, valid=found.given, measured=found.valid)
    return Accuracy.model_validate(scores.as_dict())


def scored(truth: "Truth | None", config: Config) -> Scored | None:
    """Which part of the frame is scored with this truth, and how much of it the candidates cannot reach."""
    from softdepth.golden.score.metrics import coverage

    if truth is None:
        return None
    return Scored.model_validate(asdict(coverage(truth, config.min_disparity, config.max_disparity)))


def write(folder: Path, pair: "StereoPair", config: Config, measurement: Measurement, report: Report) -> None:
    """Write the maps, the pictures, the configuration and the report of a run into `folder`."""
    from softdepth.golden.data import writers
    from softdepth.golden.score import figures, pictures

    result = measurement.result
    disparity, code, valid = result.pixels, result.code, result.given
    low, high = pictures.colour_range(disparity, valid)
    writers.write_disparity_png(folder / "disparity.png", disparity, valid, first=config.min_disparity)
    writers.write_pfm(folder / "disparity.pfm", disparity, valid)
    coloured = pictures.colour(disparity, valid, high, minimum=low, code=code)
    writers.write_picture(folder / "colour.png", coloured)
    write_atomically(folder / "code.png", pictures.code_picture(code))
    shown = pair.as_format("rgb8")
    overview = figures.triptych(shown.left, shown.right, disparity, valid, high, minimum=low, code=code)
    write_atomically(folder / "overview.png", overview)
    if pair.truth is not None:
        errors = pictures.error_picture(disparity, pair.truth, valid)
        write_atomically(folder / "error.png", figures.error_figure(errors))
    config.save(folder / "config.toml")
    (folder / "report.json").write_text(json.dumps(report.model_dump(), indent=2) + "\n")


def show(report: Report) -> None:
    """Print the report as a user reads it."""
    name, digest = report.config["name"], report.config_hash
    print(f"{report.pair}, {report.width}x{report.height} = {report.pixels} pixels; {name} ({digest})")
    screen.console().print(_table(report))
    print(_scored(report))
    if report.rtl_mismatches is None:
        return
    print(f"gateware against fixed model: {report.rtl_mismatches} mismatches in {report.pixels} pixels")
    if report.link is not None:
        print(_link(report.link))
        return
    print(f"{report.cycles_per_pixel:.3f} clock cycles per pixel")
    print(f"{report.sim_pixels_per_second:,.0f} simulated pixels per second")


def _scored(report: Report) -> str:
    """What the scores are over, in a line."""
    from softdepth.golden.score.metrics import Coverage

    if report.truth is None:
        return "scored: no pixel, because no ground truth is given"
    return str(Coverage(**report.truth.model_dump()))


def _link(counters: dict[str, int]) -> str:
    """What happened on the serial line, in a line."""
    broken = counters["broken"] + counters["board_broken"]
    return (
        f"serial link: {counters['sent']} packets sent, {broken} arrived broken,"
        f" {counters['repeated']} sent again, {counters['timeouts']} answers missing"
    )


def _table(report: Report) -> Table:
    gateware: tuple[Engine, str] = ("board", "board") if report.engine == "board" else ("rtl", "gateware")
    titles: dict[Engine, str] = {
        gateware[0]: gateware[1],
        "fixed": "fixed",
        "float": "float",
        "paper": "preset paper",
        "sad": "plain SAD",
    }
    engines: list[Engine] = [
        engine for engine in titles if engine != "paper" or report.seconds["paper"] is not None
    ]
    table = Table("", *(titles[engine] for engine in engines), box=None)
    for column in table.columns[1:]:
        column.justify = "right"
    for label, key, unit in (
        ("bad pixels, off by > 1 px", "bad1", " %"),
        ("bad pixels, off by > 2 px", "bad2", " %"),
        ("mean absolute error", "mae", " px"),
        ("RMS error", "rmse", " px"),
        ("paper's RMSE, gray levels", "paper_rmse", ""),
        ("pixels measured", "density", " %"),
    ):
        scores = [getattr(report.metrics[engine], key) for engine in engines]
        table.add_row(label, *("-" if score is None else f"{score:.2f}{unit}" for score in scores))
    seconds = [report.seconds[engine] for engine in engines]
    table.add_row("seconds", *("-" if s is None else f"{s:.1f}" for s in seconds))
    return table


def _tools(simulated: bool) -> dict[str, str | None]:
    names = ("softdepth", "numpy", "opencv-python-headless", "amaranth", "cocotb")
    found: dict[str, str | None] = {"python": platform.python_version(), **{n: version(n) for n in names}}
    found["verilator"] = found["compiler"] = None
    if simulated:
        from softdepth.sim.toolchain import find_toolchain

        toolchain = find_toolchain()
        found["verilator"], found["compiler"] = toolchain.verilator_version, toolchain.compiler_version
    return found
