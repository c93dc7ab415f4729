"""Plots of confidence: what is left of the error when the least sure are left out, and error against it."""

import io
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from softdepth.studies.evaluate.document import Evaluation
from softdepth.studies.evaluate.score import STEPS

INK, GRID = "#1f2328", "#d8dee4"
COLOURS = ("#0969da", "#cf222e", "#1a7f37", "#8250df", "#9a6700")
BINS = 16
FEW = 200
"""With fewer pixels than this, the error of a bin means nothing."""


def confidence(evaluation: Evaluation) -> bytes:
    """A PNG file of two panels, a line a preset: sparsification curves, and bad pixels by confidence."""
    figure = Figure(figsize=(10, 3.9), dpi=120, facecolor="white", layout="constrained")
    canvas = FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    for (name, curves), colour in zip(_curves(evaluation).items(), COLOURS * 9, strict=False):
        shares = np.arange(STEPS) * 100 / STEPS
        left.plot(shares, curves[0], color=colour, label=name)
        left.plot(shares, curves[1], color=colour, linestyle=":", linewidth=1)
    for (name, (levels, bad)), colour in zip(histograms(evaluation).items(), COLOURS * 9, strict=False):
        counts, wrong = (np.asarray(h).reshape(BINS, -1).sum(axis=1) for h in (levels, bad))
        known = counts >= FEW
        centres = (np.arange(BINS) + 0.5) * 256 / BINS
        right.plot(
            centres[known], 100 * wrong[known] / counts[known], color=colour, marker="o", ms=3, label=name
        )
    _finish(left, "least sure left out, % of the measured", "off by > 1 px, %")
    _finish(right, "confidence", "off by > 1 px, %")
    left.set_title("Sparsification (dotted: the best order)", fontsize=11, color=INK)
    right.set_title("Error against confidence", fontsize=11, color=INK)
    file = io.BytesIO()
    canvas.print_png(file)
    return file.getvalue()


def histograms(evaluation: Evaluation) -> dict[str, tuple[list[int], list[int]]]:
    """Of every preset with confidences, over all scenes: pixels by confidence, and bad ones."""
    found = {}
    for name in evaluation.presets:
        scenes = [scene for scene in evaluation.scenes if name in scene.levels]
        if scenes:
            found[name] = tuple(
                np.sum([getattr(s, key)[name] for s in scenes], axis=0).tolist()
                for key in ("levels", "bad_levels")
            )
    return found


def _curves(evaluation: Evaluation) -> Mapping[str, Sequence[np.ndarray]]:
    """The mean of the scenes' curves: by confidence, and in the best order."""
    return {
        name: [
            np.mean(
                [getattr(s.sparsification[name], key) for s in evaluation.scenes if name in s.sparsification],
                0,
            )
            for key in ("bad1", "best")
        ]
        for name in evaluation.presets
        if any(name in scene.sparsification for scene in evaluation.scenes)
    }


def _finish(axes: Axes, across: str, up: str) -> None:
    axes.set_xlabel(across, fontsize=9, color=INK)
    axes.set_ylabel(up, fontsize=9, color=INK)
    axes.set_ylim(bottom=0)
    axes.grid(color=GRID, linewidth=0.6)
    axes.tick_params(labelsize=8, color=INK, labelcolor=INK)
    axes.spines[["top", "right"]].set_visible(False)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=9)
