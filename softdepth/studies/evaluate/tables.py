"""The tables of an evaluation, as rows of text: Markdown and HTML are made of them."""

from typing import NamedTuple

from softdepth.studies.evaluate.degrade import WAYS
from softdepth.studies.evaluate.document import CLEAN, Evaluation
from softdepth.studies.evaluate.lanes import CORE
from softdepth.studies.evaluate.score import Score
from softdepth.studies.evaluate.variants import SMALL

RIVALS = {"hh": "HH", "sgbm": "SGBM"}
"""Whose errors ours are divided by."""


_FOUR = ("bad-1 non-occluded", "bad-2", "bad-1 all", "bad-2")


class Table(NamedTuple):
    """A heading, what it says, and rows: the first is the head. The first `names` columns hold no numbers."""

    title: str
    text: str
    rows: list[list[str]]
    names: int = 1


def tables(evaluation: Evaluation) -> list[Table]:
    """All tables that have something to show, in reading order."""
    found = [overview(evaluation)]
    if len(evaluation.groups) > 1:
        found.append(by_group(evaluation))
    if len(evaluation.ways) > 1:
        found.append(by_way(evaluation))
    if evaluation.fuzzy:
        found.append(fuzzy(evaluation))
    if evaluation.ablations:
        found.append(ablation(evaluation))
    if any(scene.sparsification for scene in evaluation.scenes):
        found.append(confidence(evaluation))
    found.append(by_scene(evaluation))
    return found


def overview(evaluation: Evaluation) -> Table:
    """Every method over all scenes."""
    head = [
        "method",
        *_FOUR,
        "error",
        "of HH's",
        "of SGBM's",
        "measured",
    ]
    rows = [head]
    for method in _shown(evaluation):
        score = evaluation.score(method)
        ratios = [f"{evaluation.ratio(method, rival):.3f}" for rival in RIVALS]
        measured = "-" if score.measured is None else f"{score.measured:.1f} %"
        rows.append([evaluation.methods[method], *_figures(score), *ratios, measured])
    text = (
        "Per cent of the pixels with known truth that are off by more than 1 and 2 px, as a mean over"
        f" {len(evaluation.scenes)} scenes. *Error* is the mean of the four. *Of HH's* and *of SGBM's* are"
        " the geometric mean over scenes of the ratio to that matcher's error on the same scene. *Measured*"
        " is the share of pixels that were not filled."
    )
    return Table("All scenes", text, rows)


def by_group(evaluation: Evaluation) -> Table:
    """Errors and ratios of each data set."""
    methods = _shown(evaluation)
    rows = [["data set", "scenes", *(evaluation.methods[m] for m in methods)]]
    for group in evaluation.groups:
        count = sum(scene.group == group for scene in evaluation.scenes)
        cells = [
            f"{evaluation.score(m, group=group).error:.2f} ({evaluation.ratio(m, 'hh', group=group):.2f})"
            for m in methods
        ]
        rows.append([group, str(count), *cells])
    return Table("By data set", "Mean error, with its ratio to HH's in brackets.", rows)


def by_way(evaluation: Evaluation) -> Table:
    """Errors on pairs that were made worse."""
    methods = _shown(evaluation)
    rows = [["pairs", *(evaluation.methods[m] for m in methods)]]
    for way in evaluation.ways:
        title = "unchanged" if way == CLEAN else WAYS[way][0]
        rows.append([title, *(f"{evaluation.score(m, way).error:.2f}" for m in methods)])
    return Table("Degraded pairs", "Mean error over all scenes.", rows)


def fuzzy(evaluation: Evaluation) -> Table:
    """The costs over the same criteria, and the paper's method on the gradient."""
    lanes = evaluation.lanes
    rows = [["cost", *_FOUR, "error", "of HH's", *(("LUT4 per lane", "multipliers") if lanes else ())]]
    for method in evaluation.fuzzy:
        taken = []
        if lanes:
            lane = lanes.get(method)
            taken = [f"{lane.lut4:,}", f"{lane.multipliers:.1f}"] if lane else ["-", "-"]
        rows.append(
            [method, *_figures(evaluation.score(method)), f"{evaluation.ratio(method, 'hh'):.3f}", *taken]
        )
    text = (
        "The sum of census, gradient over 5x5 and gradient over 9x9, and fuzzy inference over the same three"
        " (labels at 2^8, 2^8 and 2^9), all with the post-processing of `robust`. Below them is the preset"
        " `paper` with invalid pixels filled, on colours as in the paper, and on the gradient (labels at"
        " 2^10)."
    )
    if lanes:
        text += (
            " *LUT4 per lane* counts what compares a candidate's pixels, sums them and makes a cost of the"
            f" sums, without the winners, on ECP5 (`{'`, `'.join(CORE)}`). *Multipliers* are the core's,"
            " divided by its lanes."
        )
    return Table("Fuzzy or not", text, rows)


def ablation(evaluation: Evaluation) -> Table:
    """What each saving of `robust-small` costs in accuracy."""
    rows = [["taken back", *_FOUR, "error", "of HH's", "of SGBM's"]]
    for method in (SMALL, *evaluation.ablations):
        if method not in evaluation.methods:
            continue
        ratios = (f"{evaluation.ratio(method, rival):.3f}" for rival in RIVALS)
        name = "nothing" if method == SMALL else method
        rows.append([name, *_figures(evaluation.score(method)), *ratios])
    text = (
        "The preset `robust-small` with one of its savings taken back: with sums over 9x9, or with one of the"
        " filters as in `robust`. The last row has all of them taken back."
    )
    return Table("Ablation of `robust-small`", text, rows)


def confidence(evaluation: Evaluation) -> Table:
    """How well confidences order the measured pixels."""
    rows = [["preset", "off by > 1 px, all measured", "surest half", "area", "best area"]]
    for name in evaluation.presets:
        found = [s.sparsification[name] for s in evaluation.scenes if name in s.sparsification]
        if found:
            figures = (
                [f.bad1[0] for f in found],
                [f.bad1[len(f.bad1) // 2] for f in found],
                [f.area for f in found],
                [f.best_area for f in found],
            )
            rows.append([f"`{name}`", *(f"{sum(v) / len(v):.2f}" for v in figures)])
    text = (
        "Per cent of the measured pixels with known truth, as a mean over the scenes. *Area* is the area"
        " under the sparsification curve, that is, its mean while the least sure 0 to 95 % are left out."
        " *Best area* is the same if the worst errors are left out first."
    )
    return Table("Confidence", text, rows)


def by_scene(evaluation: Evaluation) -> Table:
    """Every scene's errors."""
    methods = _shown(evaluation)
    rows = [["scene", "data set", "size", *(evaluation.methods[m] for m in methods)]]
    for scene in evaluation.scenes:
        errors = (f"{scene.scores[CLEAN][m].error:.2f}" for m in methods)
        rows.append([scene.name, scene.group, f"{scene.width}x{scene.height}", *errors])
    return Table("By scene", "Error.", rows, names=2)


def _figures(score: Score) -> list[str]:
    """Cells for `_FOUR` and the error."""
    values = score.nonocc1, score.nonocc2, score.all1, score.all2, score.error
    return [f"{value:.2f}" for value in values]


def _shown(evaluation: Evaluation) -> list[str]:
    """The methods of the main tables."""
    left_out = {*evaluation.fuzzy, *evaluation.ablations}
    return [method for method in evaluation.methods if method not in left_out]
