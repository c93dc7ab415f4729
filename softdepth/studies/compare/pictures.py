"""Pictures of a comparison: where the models differ, and accuracy against number format."""

import io
from collections.abc import Callable

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from softdepth.golden.maps import DisparityMap
from softdepth.golden.score.figures import INCHES, side_by_side
from softdepth.golden.score.pictures import NO_RESULT, colour, colour_range
from softdepth.studies.compare.sweep import Point, Sweep

Rgb = tuple[int, int, int]

DIFFERENCE_COLOURS: dict[str, Rgb] = {
    "off by 1 px": (255, 214, 10),
    "2 px": (255, 128, 0),
    "more": (230, 20, 60),
    "no result": NO_RESULT,
}
"""The legend of `differences`."""

PANEL_PIXELS = 900
"""About how wide a panel of `differences` is."""

WORSE = 8
"""Percentage points above the float model's bad pixels that `sweep_plot` shows: beyond, nobody builds."""

INK = "#1f2328"
RING = "#d1242f"
GRID = "#d8dee4"


def mark_differences(reference: np.ndarray, first: DisparityMap, second: DisparityMap) -> np.ndarray:
    """The reference image, gray and dimmed, its pixels in `DIFFERENCE_COLOURS` where two maps differ.

    `reference` is uint8 RGB, H x W x 3, as is the result.
    """
    gray = reference.astype(np.float64).mean(axis=2, keepdims=True)
    picture = np.repeat(70 + 0.42 * gray, 3, axis=2).astype(np.uint8)
    distance = np.abs(first.disparity.astype(np.int64) - second.disparity)
    for name, where in (
        ("off by 1 px", distance == 1),
        ("2 px", distance == 2),
        ("more", distance > 2),
        ("no result", ~(first.valid & second.valid)),
    ):
        picture[where] = DIFFERENCE_COLOURS[name]
    return picture


def differences(reference: np.ndarray, result: DisparityMap, paper: DisparityMap) -> bytes:
    """Where the result departs from the float model, beside the result itself: a PNG file's bytes."""
    low, high = colour_range(result.pixels, result.given)
    panels = (
        ("where hardware and float model differ", mark_differences(reference, result, paper)),
        ("hardware's disparity", colour(result.pixels, result.given, high, minimum=low, code=result.code)),
    )
    width = reference.shape[1]
    zoom = max(1, round(PANEL_PIXELS / width))  # a whole one: single pixels stay sharp
    dpi = round(zoom * width / INCHES)
    return side_by_side(panels, maximum=high, minimum=low, legend=DIFFERENCE_COLOURS, dpi=dpi)


def sweep_plot(found: Sweep, title: str, float_bad1: float | None, marked: tuple[int, int | None]) -> bytes:
    """Difference from the float model, and bad pixels, against membership bits: a PNG file's bytes.

    Parameters
    ----------
    float_bad1 : bad pixels of the float model with the paper's label; None drops that panel.
    marked : membership bits and label bits of the compared configuration, which gets a ring.
    """
    panels: list[tuple[str, str, Callable[[Point], float | None]]] = [
        ("from the float model, T = 5000", "RMS difference in px", lambda p: p.to_float.rmse),
        ("from the float model, same T", "RMS difference in px", lambda p: p.to_same_label.rmse),
    ]
    if float_bad1 is not None:
        panels.append(("from the truth", "bad pixels (> 1 px) in %", lambda p: p.accuracy.bad1))
    figure = Figure(figsize=(4.2 * len(panels), 4.3), dpi=150, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(f"Number formats: {title}", fontsize=12, color=INK)
    every = figure.subplots(1, len(panels))
    every[1].sharey(every[0])
    for axes, (heading, unit, value) in zip(every, panels, strict=True):
        _lines(axes, found, value, marked)
        axes.set_xticks(found.membership_bits)
        _dress(axes, heading, unit)
    if float_bad1 is not None:
        every[-1].set_ylim(None, float_bad1 + WORSE)
        every[-1].axhline(float_bad1, color=INK, linewidth=1, linestyle=(0, (4, 3)), label="float, T = 5000")
    handles, labels = every[-1].get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc="outside lower center",
        ncols=len(labels),
        frameon=False,
        fontsize=9.5,
        labelcolor=INK,
    )
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return file.getvalue()


def _lines(
    axes: Axes, found: Sweep, value: Callable[[Point], float | None], marked: tuple[int, int | None]
) -> None:
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.88, len(found.labels)))
    for shade, label in zip(shades, found.label_bits, strict=True):
        points = [p for p in found.points if p.label_bits == label]
        bits, values = np.array([(p.membership_bits, value(p)) for p in points], float).T
        axes.plot(
            bits, values, color=shade, linewidth=1.8, marker="o", markersize=4, label=f"$T = 2^{{{label}}}$"
        )
    ringed = found.point(marked[0], marked[1]) if marked[1] is not None else None
    if ringed is not None:
        axes.plot(
            *np.array([[ringed.membership_bits], [value(ringed)]], float),
            linestyle="none",
            marker="o",
            markersize=12,
            markerfacecolor="none",
            markeredgecolor=RING,
            markeredgewidth=1.8,
            label="this configuration",
        )


def _dress(axes: Axes, heading: str, unit: str) -> None:
    axes.set_title(heading, fontsize=10.5, color=INK, loc="left")
    axes.set_xlabel("membership bits", fontsize=9.5, color=INK)
    axes.set_ylabel(unit, fontsize=9.5, color=INK)
    axes.tick_params(labelsize=9, colors=INK, length=0)
    axes.grid(color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    for side, spine in axes.spines.items():
        spine.set_visible(side == "bottom")
        spine.set_color(GRID)
