"""The pictures of the evaluation's page, as data URIs: maps, errors and cost curves."""

import base64
import io
from collections.abc import Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from softdepth.golden.data.truth import GRAY_PER_PIXEL, Truth
from softdepth.golden.score import pictures
from softdepth.studies.paper.cells import Found
from softdepth.studies.paper.figure4 import Point

_INK, _BEFORE, _AFTER = "#1f2328", "#b3261e", "#1f6feb"


def data_uri(png: bytes) -> str:
    """A PNG file's bytes as a ``data:`` address."""
    return f"data:image/png;base64,{base64.b64encode(png).decode('ascii')}"


def depth(found: Found, maximum: float) -> str:
    """The map in colour, far blue to near red."""
    return _picture(pictures.colour(found.disparity, found.valid, maximum))


def errors(found: Found, truth: Truth) -> str:
    """Where the map is within 1 px, within 2 px, and wrong."""
    return _picture(pictures.error_picture(found.disparity, truth, found.valid))


def gray(found: Found, first: int) -> str:
    """The map as the paper draws it: ``4 * (d + first)`` in a byte."""
    drawn = np.rint(GRAY_PER_PIXEL * (found.disparity.astype(np.float64) + first)) % 256
    levels = np.where(found.valid, drawn, 0).astype(np.uint8)
    return _picture(np.repeat(levels[:, :, None], 3, axis=2))


def truth_gray(truth: Truth) -> str:
    """The truth's gray levels."""
    return _picture(np.repeat(truth.gray.astype(np.uint8)[:, :, None], 3, axis=2))


def curves(points: Sequence[Point]) -> str:
    """Fig. 4 b and c: a pixel's cost of every candidate, without the rule and with it, by its judge."""
    figure = Figure(figsize=(13.2, 2.9), dpi=110, facecolor="white")
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots(1, 1 + len(points), sharey=True)
    figure.subplots_adjust(left=0.04, right=0.995, bottom=0.17, top=0.9, wspace=0.06)
    panels = [("no rule", points[0].costs_before, points[0].before, _BEFORE)]
    panels += [
        (f"rule judged by {p.judged_by}x{p.judged_by}", p.costs_after, p.after, _AFTER) for p in points
    ]
    top = 1.2 * max(points[0].costs_before)
    for ax, (title, costs, least, colour) in zip(axes, panels, strict=True):
        index = np.arange(1, len(costs) + 1)
        ax.plot(index, costs, color=colour, linewidth=1.4)
        ax.plot([least], [costs[least - 1]], "o", color=colour, markersize=6)
        ax.annotate(
            f"{least}",
            (least, costs[least - 1]),
            xytext=(0, -15),
            textcoords="offset points",
            ha="center",
            color=colour,
            fontsize=10,
            fontweight="bold",
        )
        ax.set_title(title, fontsize=10, color=_INK)
        ax.set_xlabel("candidate, counted from one", fontsize=9, color=_INK)
        ax.set_xlim(1, len(costs))
        ax.set_ylim(-0.2 * top, top)  # rejected candidates cost 10, far above
        ax.grid(alpha=0.25)
        ax.tick_params(labelsize=8, colors=_INK)
        ax.spines[["top", "right"]].set_visible(False)
    axes[0].set_ylabel("cost (eq. 10)", fontsize=9, color=_INK)
    file = io.BytesIO()
    canvas.print_png(file)
    return data_uri(file.getvalue())


def _picture(rgb: np.ndarray) -> str:
    """With a palette: the maps have at most 256 colours, and the page a third of the bytes."""
    file = io.BytesIO()
    Image.fromarray(rgb).quantize(256).save(file, "PNG")
    return data_uri(file.getvalue())
