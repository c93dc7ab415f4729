"""A comparison as Markdown."""

from collections.abc import Callable

from softdepth.studies.compare.comparison import Comparison
from softdepth.studies.compare.sweep import TOLERANCE, Point
from softdepth.templates import render

PAPER_LABEL = 5000
"""The float model's label, as in the paper."""


def title(found: Comparison) -> str:
    """Pair, preset and operator."""
    return f"{found.pair}, {found.config['name']}, {found.config['operator']}"


def common_label(found: Comparison) -> int | None:
    """The label bits that all criteria of the compared configuration share, or None."""
    labels = {criterion["label_bits"] for criterion in found.config["criteria"]}
    return labels.pop() if len(labels) == 1 else None


def sentence(found: Comparison) -> str:
    """The result against the float model, in one sentence."""
    a = found.agreement
    who = "gateware" if found.engine == "rtl" else "fixed model"
    return (
        f"{who} against float model: {a.differ:.2f} % of {a.pixels} pixels differ, {a.differ1:.2f} % by more"
        f" than 1 px, {a.differ2:.2f} % by more than 2 px; RMSE {a.rmse:.2f} px"
    )


def enough(found: Comparison) -> list[str]:
    """Which widths are enough, a line per label; nothing where the truth is unknown."""
    if found.metrics["float"].bad1 is None:
        return []
    return [
        f"label 2^{label.label_bits}: "
        + (
            f"{label.enough} membership bits are enough"
            if label.enough
            else f"no width up to {found.sweep.membership_bits[-1]} bits is enough"
        )
        for label in found.sweep.labels
    ] + [f"(enough: at most {TOLERANCE} percentage points more bad pixels, > 1 px, than the float model)"]


def page(found: Comparison) -> str:
    """The whole comparison: summary, then one table of formats per question."""
    text = render(
        "softdepth.studies",
        "comparison.md",
        title=title(found),
        sentence=sentence(found),
        agreement=found.agreement,
        grids=[(heading, *table([found], figure)) for heading, figure in figures(found).items()],
        enough=enough(found),
    )
    return text + "\n"


def figures(found: Comparison) -> dict[str, Callable[[Point], float | None]]:
    """The tables of a comparison: heading, and what is read from a point."""
    shown: dict[str, Callable[[Point], float | None]] = {
        f"RMSE to the float model with T = {PAPER_LABEL}, px": lambda p: p.to_float.rmse,
        "RMSE to the float model with the same label, px": lambda p: p.to_same_label.rmse,
    }
    if found.metrics["float"].bad1 is not None:
        shown["Bad pixels, off by more than 1 px, %"] = lambda p: p.accuracy.bad1
        shown["The paper's RMSE, gray levels"] = lambda p: p.accuracy.paper_rmse
    return shown


def table(
    many: list[Comparison], figure: Callable[[Point], float | None]
) -> tuple[list[str], list[list[str]]]:
    """`figure` by membership bits and label, the mean over some comparisons: the head, and the rows."""
    first = many[0].sweep
    head = ["membership bits", *(f"T = 2^{label}" for label in first.label_bits)]
    rows = []
    for bits in first.membership_bits:
        points = [[found.sweep.point(bits, label) for found in many] for label in first.label_bits]
        rows.append([str(bits), *(_mean(each, figure) for each in points)])
    return head, rows


def _mean(points: list[Point | None], figure: Callable[[Point], float | None]) -> str:
    values = [value for p in points if p is not None and (value := figure(p)) is not None]
    return f"{sum(values) / len(values):.2f}" if values else "-"
