"""What the commands that take sequences have in common: checks before long work, the work, its files."""

import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import ending, screen
from softdepth.cli import calibrations, metres, options
from softdepth.files import make_folder, refuse_to_replace
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.board.device import Device
    from softdepth.golden.data.images import Joined
    from softdepth.rig.rectify import Rectifier
    from softdepth.sequence.frame import Engine, Recipe, Record
    from softdepth.sequence.frames import Checked
    from softdepth.sequence.input import Input
    from softdepth.spec.config import Config

Processes = Annotated[
    int | None,
    typer.Option(
        "--processes", metavar="N", min=1, help="Processes for models and files [default: all cores]."
    ),
]
Rate = Annotated[
    float | None,
    typer.Option("--fps", metavar="N", help="Frames a second of the preview [default: the video's, or 10]."),
]

FRAMES, PREVIEW = "frames", "preview.webm"
DEFAULT_RATE = 10.0


@dataclass(frozen=True)
class Given:
    """The sequence that a user names."""

    left: Path
    right: Path | None
    joined: "Joined | None" = None
    bits: int | None = None
    truth: Path | None = None
    scale: float | None = None


@dataclass(frozen=True)
class Plan:
    """One rig's sequence, its cameras, and where its results go. `name` is the rig's, if it has one."""

    name: str
    given: Given
    cameras: metres.Cameras
    raw: calibrations.Raw
    output: Path


@dataclass(frozen=True)
class How:
    """The engine, the processes that work beside it, and the preview's frames a second, if they are given."""

    engine: "Engine"
    processes: int
    rate: float | None = None
    device: "Device | None" = None


@dataclass(frozen=True)
class Ready:
    """A plan that has been checked to its last frame."""

    plan: Plan
    source: "Input"
    recipe: "Recipe"
    rectifier: "Rectifier | None"

    @property
    def checked(self) -> "Checked":
        """The sequence as it was read."""
        return self.source.checked


def prepare(
    plan: Plan, choice: options.Choice | None, kept: metres.Kept, how: How, config: "Config | None" = None
) -> Ready:
    """Read a sequence once, to find everything that is wrong before the long work begins.

    `config` is that of a core that exists already. Without it, `choice` says what the core is, and it is made
    as large as the frames. Raises `InputError` and `ConfigError`.
    """
    from softdepth.run import measure
    from softdepth.sequence import frames, input
    from softdepth.sequence.frame import Recipe

    given = plan.given
    if given.scale is not None and given.truth is None:
        raise InputError(f"--gt-scale {given.scale:g} without --gt", "name the ground truth it belongs to")
    if how.rate is not None and not 0.1 <= how.rate <= 240:
        raise InputError(f"--fps {how.rate:g} is not a rate", "give 0.1 to 240 frames a second")
    found = frames.find(given.left, given.right, given.joined)
    plan.raw.check(None, plan.output)
    _refuse_inputs(plan, found.files)
    truths = () if given.truth is None else input.truths(given.truth, found.expected)
    with screen.progress("checking", found.expected, "frames") as advance:
        checked = frames.checked(found, given.bits, advance)
    chosen = config or (choice or options.Choice()).configuration()
    first = checked.first.as_format(chosen.pixel)
    for text in first.notes:
        screen.note(f"note: {text}")
    if checked.missing:
        screen.note(f"warning: {checked.missing}: the results will be of these alone")
    if config is None and choice is not None:
        keys = [key for key in measure.LIMITS if not choice.sets(key)]
        chosen = measure.as_large_as(first, chosen, keys)
    measure.check_fits(first, chosen, again=options.command, built=config is not None)
    _, geometry, rectifier = metres.prepare(first, plan.cameras, plan.raw)
    wanted = kept.choice()
    kept.check(chosen, geometry is not None)
    about = "" if how.device is None else f"{how.device.description.board} {how.device.description.revision}"
    recipe = Recipe(chosen, how.engine, geometry, wanted, kept.disparity_error, about)
    source = input.Input(found, checked, chosen, rectifier, truths, given.scale)
    if truths and len(truths) != len(checked.names):
        raise InputError(f"{len(truths)} truths for {len(checked.names)} frames", "give one a frame")
    source.check_truths()
    return Ready(plan, source, recipe, rectifier)


def run(ready: Ready, how: How) -> int:
    """Compute what is missing of a sequence, write its tables and its preview, and report it.

    Returns the number of pixels in which gateware and model differ.
    """
    from softdepth.sequence import preview, table, video
    from softdepth.sequence.work import Work

    output, checked = ready.plan.output, ready.checked
    folder = output / FRAMES
    make_folder(folder)
    (output / table.SUMMARY).unlink(missing_ok=True)
    others = [each for each in folder.iterdir() if each.is_dir() and each.name not in checked.names]
    if others:
        screen.note(f"note: {len(others)} folders in '{folder}' are of other frames; they are left alone")
    start = time.monotonic()
    work = Work(ready.source.pairs, checked.names, ready.recipe, folder, how.processes, how.device)
    try:
        records = work.run()
    except BaseException:
        for each in (folder, output):  # where nothing came of it
            with suppress(OSError):
                each.rmdir()
        raise
    seconds = time.monotonic() - start
    if ready.rectifier is not None:
        calibrations.write(output, ready.rectifier, checked.first)
    ready.recipe.config.save(output / "config.toml")
    rate = how.rate or ready.source.frames.rate or DEFAULT_RATE
    video.write(output / PREVIEW, preview.shown(records, folder), rate)
    name = ready.plan.name or ready.plan.given.left.name
    summary = table.summary(name, ready.recipe, records, seconds, checked.missing)
    table.write(output, summary, records)
    _show(summary, records, name)
    if checked.missing:
        screen.note(f"warning: {checked.missing}; the rest is not in these results")
    print(f"results: {output}")
    return summary["mismatches"] or 0


def fail_on_mismatch(mismatches: int) -> None:
    """End the command with `ending.MISMATCH` where gateware and fixed model differ."""
    if mismatches:
        screen.note(
            f"error: gateware and fixed-point model differ in {mismatches} pixels; frame.json names some"
        )
        raise typer.Exit(ending.MISMATCH)


def _show(summary: dict, records: "list[Record]", name: str) -> None:
    from rich.table import Table

    from softdepth.sequence import table

    shown = Table("", "mean", "lowest", "highest", box=None)
    for column in shown.columns[1:]:
        column.justify = "right"
    for column in table.columns(records):
        values = [value for record in records if (value := column.value(record)) is not None]
        if column.decimals is None or not values:
            continue
        figures = summary["mean"][column.key], min(values), max(values)
        shown.add_row(column.title, *(f"{value:,.{column.decimals}f}" for value in figures))
    kept = summary["frames"] - summary["computed"]
    from_before = f", {kept} of them from an earlier run" if kept else ""
    config = summary["config"]["name"]
    print(f"{name}: {summary['frames']} frames{from_before}; {config} ({summary['config_hash']})")
    screen.console().print(shown)
    if summary["computed"]:
        print(
            f"{summary['computed']} frames in {screen.duration(summary['seconds'])}:"
            f" {summary['frames_per_second']:.2f} frames a second"
        )
    if summary["engine"] == "board" and summary["engine_frames_per_second"]:
        print(f"board: {summary['engine_frames_per_second']:.2f} frames a second, there and back")
    if summary["mismatches"] is not None:
        print(f"gateware against fixed model: {summary['mismatches']} mismatches")


def _refuse_inputs(plan: Plan, files: tuple[Path, ...]) -> None:
    """Raise `InputError` if results would replace what is read, or a folder that is not of a sequence."""
    from softdepth.sequence.frame import REPORT
    from softdepth.sequence.table import CSV, MARKDOWN, SUMMARY

    read = [*files, *(plan.cameras.calibration or ()), *(plan.raw.rectify or ())]
    refuse_to_replace(plan.output, (CSV, MARKDOWN, SUMMARY, PREVIEW, "config.toml"), read)
    results = (plan.output / FRAMES).resolve()
    for path in (*read, *([plan.given.truth] if plan.given.truth else ())):
        if path.resolve().is_relative_to(results):
            raise InputError(f"the results would replace '{path}', which is read", "choose another with -o")
    if results.is_dir():
        for each in results.iterdir():
            if each.is_dir() and any(each.iterdir()) and not (each / REPORT).exists():
                if each.name.startswith("."):
                    continue
                raise InputError(f"'{each}' is not a frame of softdepth's", "choose another folder with -o")
