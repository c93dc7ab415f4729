"""``python -m softdepth.studies.inspections``: how often `softdepth inspect` is right, in docs/inspect.md.

The scenes lie in the folder that ``SOFTDEPTH_SCENES`` names, one folder each with ``left.png``, ``right.png``
and ``truth.pfm``; those of `softdepth datasets` are added where ``SOFTDEPTH_DATA`` is set.
"""

import os
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from softdepth import screen
from softdepth.files import write_atomically
from softdepth.golden.data import datasets
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.truth import read_truth
from softdepth.inspect.inspection import Inspection, inspect
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError, SoftdepthError
from softdepth.studies import markers
from softdepth.studies.broken import Broken, variants
from softdepth.templates import render

SCENES_VARIABLE = "SOFTDEPTH_SCENES"
DOCUMENT = Path("docs/inspect.md")
PART = "inspections"
CONFIG = Config.preset("paper")
COVERED = 99
"""Per cent of the known disparities that a range must hold to be enough."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A pair of uint8 RGB images, and its known disparities (float N, in pixels)."""

    name: str
    left: np.ndarray
    right: np.ndarray
    known: np.ndarray


@dataclass
class Tally:
    """The pairs that are broken in one way: how many there are, are recognised, and what else is found."""

    pairs: int = 0
    named: int = 0
    called_more: list[str] = field(default_factory=list)

    @property
    def more(self) -> list[tuple[str, int]]:
        """Other findings about them, and how often."""
        return Counter(self.called_more).most_common()


def read_scenes(folder: Path) -> list[Scene]:
    """The scenes in a folder, in the order of their names; raises `InputError` if there are none."""
    found = []
    for left in sorted(folder.glob("*/left.png")):
        pair = read_pair(left, left.with_name("right.png")).as_format("rgb8")
        truth = read_truth(left.with_name("truth.pfm"))
        found.append(Scene(left.parent.name, pair.left, pair.right, truth.disparity[truth.known]))
    if not found:
        raise InputError(f"no scenes in '{folder}'", f"set {SCENES_VARIABLE} to a folder with SCENE/left.png")
    return found


def known_sets() -> list[Scene]:
    """The pairs that `softdepth datasets` knows and that are at hand."""
    names = ["motorcycle"]
    if os.environ.get(datasets.DATA_VARIABLE):
        names += ["middlebury:teddy", "middlebury:cones", "middlebury:venus"]
    found = []
    for name in names:
        pair = datasets.load(name).as_format("rgb8")
        assert pair.truth is not None
        found.append(Scene(name, pair.left, pair.right, pair.truth.disparity[pair.truth.known]))
    return found


def codes(found: Inspection) -> set[str]:
    """What is wrong with a pair; a range that is larger than needed does no harm."""
    return {finding.code for finding in found.findings} - {"needless"}


def is_named(broken: Broken, found: Inspection, before: Inspection) -> bool:
    """Whether the finding is the right one; for an offset, whether its rows are right as well."""
    match = next((finding for finding in found.findings if finding.code == broken.code), None)
    if match is None or broken.offset is None:
        return match is not None
    was = before.measured.rows.offset if before.measured.rows else 0.0
    return abs(match.figures["offset"] - was - broken.offset) < 0.5


def judge(broken: Broken, scene: Scene, before: Inspection) -> tuple[bool, set[str]]:
    """Whether a pair's fault is recognised, and which other findings are new."""
    config = CONFIG
    if broken.halved:
        most = int(np.percentile(scene.known, COVERED))
        config = CONFIG.override([f"disparities={max(2, most // 2)}", "lanes=1"])
    found = inspect(broken.left, broken.right, config)
    return is_named(broken, found, before), codes(found) - codes(before) - {broken.code}


def study(scenes: list[Scene], rows: tuple[int, ...] | None = None) -> str:
    """The tables: findings about unchanged scenes, and how often broken ones are recognised."""
    before = {scene.name: inspect(scene.left, scene.right, CONFIG) for scene in scenes}
    tallies: dict[str, Tally] = {}
    half = len(scenes) // 2  # neighbours by name may be the same scene in different light
    for scene, other in zip(scenes, [*scenes[half:], *scenes[:half]], strict=True):
        screen.note(f"{scene.name} ...")
        for broken in variants(scene.left, scene.right, other.right, rows):
            tally = tallies.setdefault(broken.kind, Tally())
            named, more = judge(broken, scene, before[scene.name])
            tally.pairs += 1
            tally.named += named
            tally.called_more += sorted(more)
    return render(
        "softdepth.studies",
        "inspections.md",
        config=CONFIG,
        covered=COVERED,
        scenes=len(scenes),
        silent=sum(not codes(found) for found in before.values()),
        enough=sum(_holds(before[scene.name], scene) for scene in scenes),
        lines=_said(before),
        tallies=tallies,
    )


def _said(before: dict[str, Inspection]) -> list[tuple[str, str]]:
    """What is said about pairs as they are, each with the scene's name."""
    return [
        (name, line)
        for name, found in before.items()
        for finding, line in zip(found.findings, found.lines, strict=True)
        if finding.code != "needless"
    ]


def _holds(found: Inspection, scene: Scene) -> bool:
    if found.range is None:
        return False
    last = found.range.first + found.range.disparities - 1
    return float(np.percentile(scene.known, COVERED)) <= last + 0.5


def main(project: Path) -> None:
    """Renew the tables in `project`."""
    folder = os.environ.get(SCENES_VARIABLE)
    if not folder:
        raise InputError(f"{SCENES_VARIABLE} is unset", "set it to a folder with SCENE/left.png")
    path = project / DOCUMENT
    try:
        text = path.read_text()
    except OSError as error:
        raise InputError(f"'{path}' cannot be read: {error}", "run this in the project's folder") from error
    markers.renew(text, str(DOCUMENT), PART, "")  # lost markers show before the work
    tables = study([*read_scenes(Path(folder)), *known_sets()])
    write_atomically(path, markers.renew(path.read_text(), str(DOCUMENT), PART, tables).encode())


if __name__ == "__main__":
    try:
        main(Path.cwd())
    except SoftdepthError as problem:
        sys.exit(f"error: {problem}")
