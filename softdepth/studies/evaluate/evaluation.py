"""What ``softdepth evaluate`` does: the work, the files, and the lines on the screen."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.table import Table

from softdepth import screen
from softdepth.files import result_folder, write_atomically
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies import markers
from softdepth.studies.evaluate import lanes, pages, plots, tables, variants, work
from softdepth.studies.evaluate.degrade import WAYS
from softdepth.studies.evaluate.document import CLEAN, Evaluation
from softdepth.studies.evaluate.scenes import Scene

LAST = "evaluate.json"
PLOT = "confidence.png"
FILES = ("accuracy.md", "accuracy.html", PLOT)
"""Everything that is written beside ``evaluate.json``."""
EXIT_MISMATCH = 1
RIVALS_SHOWN = ("hh",)
"""OpenCV's matchers whose maps the page shows."""
PRESETS_SHOWN = 2
HEAD = (
    "method",
    "bad-1\nnonocc",
    "bad-2\nnonocc",
    "bad-1\nall",
    "bad-2\nall",
    "\nerror",
    "of\nHH's",
    "of\nSGBM's",
    "\nmeasured",
)
"""The titles on the screen, of `tables.overview`'s columns: short enough for 80 characters a line."""


@dataclass
class Outcome:
    """An evaluation, and the pictures of each scene."""

    evaluation: Evaluation
    pictures: dict[str, dict[str, bytes]]


def evaluate(
    scenes: Sequence[Scene],
    configs: Mapping[str, Config],
    *,
    engine: work.Engine = "fixed",
    degraded: bool = False,
    fuzzy: bool = False,
    ablation: bool = False,
    processes: int = 1,
) -> Outcome:
    """Evaluate configurations, by name, on scenes, showing progress.

    `degraded` adds the pairs of `degrade.WAYS`; `fuzzy` and `ablation` add configurations of `variants`,
    which are scored on clean pairs alone. Raises `InputError` for scenes that cannot be read or that a core
    cannot take.
    """
    costs = variants.compared() if fuzzy else {}
    ablations = variants.ablations() if ablation else {}
    extra = {**costs, **ablations}
    everything = {**configs, **extra}
    ways = list(WAYS) if degraded else []
    shown = [*list(configs)[:PRESETS_SHOWN], *RIVALS_SHOWN]
    done = work.run(scenes, work.Plan(everything, list(extra), ways, engine, shown), processes)
    evaluation = Evaluation(
        engine=engine,
        presets={name: config.model_dump(mode="json") for name, config in everything.items()},
        hashes={name: config.hash for name, config in everything.items()},
        fuzzy=list(costs),
        ablations=list(ablations),
        lanes=lanes.known(costs),
        methods=work.titles(everything),
        ways=[CLEAN, *ways],
        scenes=[one.result for one in done],
    )
    return Outcome(evaluation, {one.result.name: one.pictures for one in done})


def check_document(path: Path | None) -> None:
    """Raise `InputError` unless the document is there and has its markers, before the long work."""
    if path is not None:
        markers.renew(_read(path), str(path), pages.PART, "")


def write(folder: Path, outcome: Outcome, document: Path | None = None) -> None:
    """Write every file into `folder`, and renew the generated part and the plot of `document`."""
    found = outcome.evaluation
    text = pages.markdown(found)
    with result_folder(folder, stale=FILES, last=LAST) as place:
        (place / "accuracy.md").write_text(f"# Accuracy\n\n{text}\n")
        (place / "accuracy.html").write_text(pages.page(found, outcome.pictures))
        if any(scene.sparsification for scene in found.scenes):
            (place / PLOT).write_bytes(plots.confidence(found))
        (place / LAST).write_text(found.model_dump_json(indent=1) + "\n")
    if document is not None:
        renewed = markers.renew(_read(document), str(document), pages.PART, text)
        write_atomically(document, renewed.encode())
        picture = document.parent / "images" / PLOT
        if picture.parent.is_dir() and (folder / PLOT).exists():
            write_atomically(picture, (folder / PLOT).read_bytes())


def show(outcome: Outcome) -> None:
    """Print the table of all methods, and what gateware and model differ in."""
    _, *rows = tables.overview(outcome.evaluation).rows
    table = Table(*HEAD, box=None, pad_edge=False)
    for column in table.columns[1:]:
        column.justify = "right"
    for row in rows:
        name = row[0].strip("`").removeprefix("OpenCV ").replace("our filters", "filtered")
        table.add_row(name, *row[1:])
    screen.console().print(table)
    for scene in outcome.evaluation.scenes:
        for name, count in scene.mismatches.items():
            if count:
                screen.note(
                    f"error: gateware and fixed-point model of {name} differ in {count} pixels of"
                    f" {scene.name}"
                )


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read '{path}'", "give a Markdown file with markers") from error
