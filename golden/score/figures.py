"""Figures of disparity maps: pictures side by side, with legends and colour bars, as PNG."""

import io
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from softdepth.golden.score.pictures import (
    COLOUR_MAP,
    ERROR_COLOURS,
    NO_RESULT,
    Colour,
    colour,
    shaded,
)
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

_INK = "#1f2328"
INCHES = 3.6
"""Width of a panel in `side_by_side`, on paper."""

ERROR_INCHES, ERROR_PIXELS = 7.2, 900
"""Width of `error_figure`, on paper and about in pixels: its legend takes that much."""


def error_figure(picture: np.ndarray) -> bytes:
    """An `error_picture` with its legend: a PNG file's bytes, each pixel a whole number of pixels wide."""
    width = picture.shape[1]
    zoom = max(1, round(ERROR_PIXELS / width))
    dpi = max(60, round(zoom * width / ERROR_INCHES))
    return side_by_side([("error", picture)], legend=ERROR_COLOURS, dpi=dpi, inches=ERROR_INCHES)


def triptych(
    left: np.ndarray,
    right: np.ndarray,
    disparity: np.ndarray,
    valid: np.ndarray,
    maximum: float,
    *,
    minimum: float = 0,
    code: np.ndarray | None = None,
    titles: tuple[str, str, str] = ("left", "right", "disparity"),
) -> bytes:
    """The pair and its map in `colour`, side by side with a colour bar in pixels: a PNG file's bytes.

    With `code`, a legend tells the shades that occur.
    """
    pictures = (left, right, colour(disparity, valid, maximum, minimum=minimum, code=code))
    middle = COLOUR_MAP[3 * len(COLOUR_MAP) // 10]
    legend = _map_legend(code, valid, middle) if code is not None else None
    panels = tuple(zip(titles, pictures, strict=True))
    return side_by_side(panels, maximum=maximum, minimum=minimum, legend=legend)


def side_by_side(
    panels: Sequence[tuple[str, np.ndarray]],
    *,
    maximum: float | None = None,
    minimum: float = 0,
    legend: Mapping[str, Colour] | None = None,
    dpi: int = 150,
    inches: float = INCHES,
) -> bytes:
    """Any number of (title, uint8 RGB picture of one height) in a row: a PNG file's bytes.

    Parameters
    ----------
    maximum : adds the colour bar of `colour`, in pixels, at the right; it begins at `minimum`.
    legend : adds a legend below: names and their colours, such as `ERROR_COLOURS`.
    dpi, inches : size of the picture: width of a panel on paper, and pixels an inch.

    Raises
    ------
    InputError : no panel.
    """
    if not panels:
        raise InputError("there is no picture to show", "give at least one panel")
    height, width = panels[0][1].shape[:2]
    panel = inches * height / width
    gap, top, bottom = 0.08, 0.34, 0.36 if legend else 0.08
    bar = 0.75 if maximum is not None else 0.0
    across = len(panels) * (inches + gap) + gap + bar
    down = panel + top + bottom
    figure = Figure(figsize=(across, down), dpi=dpi, facecolor="white")
    canvas = FigureCanvasAgg(figure)
    for number, (title, picture) in enumerate(panels):
        axes = figure.add_axes(
            ((gap + number * (inches + gap)) / across, bottom / down, inches / across, panel / down)
        )
        axes.imshow(picture, interpolation="nearest" if picture.shape[1] < 300 else "antialiased")
        axes.set_axis_off()
        axes.set_title(title, fontsize=11, color=_INK, pad=5)
    if maximum is not None:
        place = figure.add_axes(((across - bar + 0.04) / across, bottom / down, 0.14 / across, panel / down))
        scale = ScalarMappable(Normalize(minimum, maximum), ListedColormap(COLOUR_MAP / 255))
        colour_bar = figure.colorbar(scale, cax=place)
        colour_bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
        colour_bar.ax.tick_params(labelsize=9, length=2, color=_INK, labelcolor=_INK)
        place.set_title("px", fontsize=9, color=_INK, pad=5)
    if legend:
        _legend(figure, bottom / down, legend)
    file = io.BytesIO()
    canvas.print_png(file)
    return file.getvalue()


def _legend(figure: Figure, height: float, colours: Mapping[str, Colour]) -> None:
    """One row of labelled colour patches along the bottom."""
    axes = figure.add_axes((0, 0, 1, height))
    axes.set_axis_off()
    for label, rgb in colours.items():
        shade = tuple(value / 255 for value in rgb)
        axes.scatter(
            [], [], marker="s", s=90, color=[shade], edgecolors="#8c959f", linewidths=0.5, label=label
        )
    axes.legend(loc="center", ncols=len(colours), frameon=False, fontsize=10, labelcolor=_INK)


def _map_legend(code: np.ndarray, valid: np.ndarray, middle: np.ndarray) -> dict[str, Colour]:
    """What the shades of `colour` mean, as far as they occur; `middle` is the sample to shade."""
    legend: dict[str, Colour] = {}
    names = {Validity.PARTIAL: "paler: part of the range", Validity.FILLED: "grayer: filled"}
    for kind, text in names.items():
        if (code == kind).any():
            red, green, blue = (int(value) for value in shaded(middle, kind))
            legend[text] = (red, green, blue)
    if not valid.all():
        legend["no result"] = NO_RESULT
    return legend
