"""A comparison as Markdown."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from softdepth.studies.compare.sweep import TOLERANCE, Point

if TYPE_CHECKING:
    from softdepth.studies.compare.comparison import Comparison

PAPER_LABEL = 5000
"""The float model's label, as in the paper."""


def title(found: "Comparison") -> str:
    """Pair, preset and operator."""
    return f"{found.pair}, {found.config['name']}, {found.config['operator']}"


def common_label(found: "Comparison") -> int | None:
    """The label bits that all criteria of the compared configuration share, or None."""
    labels = {criterion["label_bits"] for criterion in found.config["criteria"]}
    return labels.pop() if len(labels) == 1 else None


def sentence(found: "Comparison") -> str:
    """The result against the float model, in one sentence."""
    a = found.agreement
    who = "gateware" if found.engine == "rtl" else "fixed model"
    return (
        f"{who} against float model: {a.differ:.2f} % of {a.pixels} pixels differ, {a.differ1:.2f} % by more"
        f" than 1 px, {a.differ2:.2f} % by more than 2 px; RMSE {a.rmse:.2f} px"
    )


def enough(found: "Comparison") -> list[str]:
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


def page(found: "Comparison") -> str:
    """The whole comparison: summary, then one table of formats per question."""
    lines = [f"# Hardware against float model: {title(found)}", "", f"{sentence(found)}.", ""]
    if (a := found.agreement).closer is not None:
        lines += [
            f"Of the pixels that differ, {a.closer:.1f} % are nearer to the truth in hardware, "
            f"{a.farther:.1f} % in the float model.",
            "",
        ]
    for heading, figure in figures(found).items():
        lines += [f"## {heading}", "", *table([found], figure), ""]
    if lines_enough := enough(found):
        lines += ["## Enough", "", *(f"- {line}" for line in lines_enough), ""]
    return "\n".join(lines[:-1]) + "\n"


def figures(found: "Comparison") -> dict[str, Callable[[Point], float | None]]:
    """The tables of a comparison: heading, and what is read from a point."""
    shown: dict[str, Callable[[Point], float | None]] = {
        f"RMSE to the float model with T = {PAPER_LABEL}, px": lambda p: p.to_float.rmse,
        "RMSE to the float model with the same label, px": lambda p: p.to_same_label.rmse,
    }
    if found.metrics["float"].bad1 is not None:
        shown["Bad pixels, off by more than 1 px, %"] = lambda p: p.accuracy.bad1
        shown["The paper's RMSE, gray levels"] = lambda p: p.accuracy.paper_rmse
    return shown


def table(many: "list[Comparison]", figure: Callable[[Point], float | None]) -> list[str]:
    """`figure` by membership bits and label, the mean over some comparisons, as Markdown lines."""
    first = many[0].sweep
    rows = [
        f"| {bits} | "
        + " | ".join(
            _mean([found.sweep.point(bits, label) for found in many], figure) for label in first.label_bits
        )
        + " |"
        for bits in first.membership_bits
    ]
    return [
        "| membership bits | " + " | ".join(f"T = 2^{label}" for label in first.label_bits) + " |",
        "|---:|" + "---:|" * len(first.labels),
        *rows,
    ]


def _mean(points: list[Point | None], figure: Callable[[Point], float | None]) -> str:
    values = [value for p in points if p is not None and (value := figure(p)) is not None]
    return f"{sum(values) / len(values):.2f}" if values else "-"
