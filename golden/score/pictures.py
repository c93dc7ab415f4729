"""Pictures of disparity maps: in colour, against the truth, and side by side."""

import io
from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from softdepth.golden.data.truth import Truth
from softdepth.spec.errors import InputError

COLOUR_MAP = "turbo"
"""Blue is far, red is near."""

NO_RESULT = (38, 38, 42)
"""The colour of pixels without a result: near black."""

ERROR_COLOURS: dict[str, tuple[int, int, int]] = {
    "within 1 px": (222, 235, 227),
    "1 to 2 px": (247, 188, 66),
    "over 2 px": (200, 40, 50),
    "no result": NO_RESULT,
    "truth unknown": (128, 142, 166),
}
"""The legend of `error_picture`."""

_INK = "#1f2328"
INCHES = 3.6
"""Width of a panel in `side_by_side`, on paper."""


def colour(disparity: np.ndarray, valid: np.ndarray, maximum: float) -> np.ndarray:
    """A map of disparities (pixels, H x W) in colour: uint8 RGB, H x W x 3.

    0 is dark blue, `maximum` and more dark red; pixels that are not `valid` are `NO_RESULT`. Give
    maps that are to be compared the same `maximum`.

    Raises
    ------
    InputError : a maximum that is not positive, or a mask of another shape.
    """
    if not maximum > 0:
        raise InputError(f"the maximum disparity is {maximum}", "give a positive number of pixels")
    valid = _mask(disparity, valid, "valid mask") & np.isfinite(disparity)
    scaled = np.where(valid, disparity, 0) / maximum
    picture = matplotlib.colormaps[COLOUR_MAP](np.clip(scaled, 0, 1), bytes=True)[:, :, :3].copy()
    picture[~valid] = NO_RESULT
    return picture


def error_picture(disparity: np.ndarray, truth: Truth, valid: np.ndarray | None = None) -> np.ndarray:
    """Where a map is right and where it is wrong: uint8 RGB, H x W x 3, in `ERROR_COLOURS`.

    The classes are those of bad-1.0 and bad-2.0: up to and including 1 px, up to and including 2 px,
    more. Unknown truth wins over no result, as in the metrics.

    Raises
    ------
    InputError : shapes that differ.
    """
    known = _mask(disparity, truth.known, "truth")
    valid = np.isfinite(disparity) if valid is None else _mask(disparity, valid, "valid mask")
    error = np.abs(np.where(known, disparity - truth.disparity.astype(np.float64), 0))
    picture = np.empty((*disparity.shape, 3), np.uint8)
    picture[:] = ERROR_COLOURS["within 1 px"]
    picture[error > 1] = ERROR_COLOURS["1 to 2 px"]
    picture[error > 2] = ERROR_COLOURS["over 2 px"]
    picture[~valid] = ERROR_COLOURS["no result"]
    picture[~known] = ERROR_COLOURS["truth unknown"]
    return picture


def triptych(
    left: np.ndarray,
    right: np.ndarray,
    disparity: np.ndarray,
    valid: np.ndarray,
    maximum: float,
    *,
    titles: tuple[str, str, str] = ("left", "right", "disparity"),
) -> bytes:
    """The pair and its map in `colour`, side by side with a colour bar in pixels: a PNG file's bytes."""
    pictures = (left, right, colour(disparity, valid, maximum))
    return side_by_side(tuple(zip(titles, pictures, strict=True)), maximum=maximum)


def side_by_side(
    panels: Sequence[tuple[str, np.ndarray]],
    *,
    maximum: float | None = None,
    legend: Mapping[str, tuple[int, int, int]] | None = None,
    dpi: int = 150,
) -> bytes:
    """Any number of (title, uint8 RGB picture of one height) in a row: a PNG file's bytes.

    Parameters
    ----------
    maximum : adds the colour bar of `colour`, in pixels, at the right.
    legend : adds a legend below: names and their colours, such as `ERROR_COLOURS`.

    Raises
    ------
    InputError : no panel.
    """
    if not panels:
        raise InputError("there is no picture to show", "give at least one panel")
    height, width = panels[0][1].shape[:2]
    panel = INCHES * height / width
    gap, top, bottom = 0.08, 0.34, 0.36 if legend else 0.08
    bar = 0.75 if maximum is not None else 0.0
    across = len(panels) * (INCHES + gap) + gap + bar
    down = panel + top + bottom
    figure = Figure(figsize=(across, down), dpi=dpi, facecolor="white")
    canvas = FigureCanvasAgg(figure)
    for number, (title, picture) in enumerate(panels):
        axes = figure.add_axes(
            ((gap + number * (INCHES + gap)) / across, bottom / down, INCHES / across, panel / down)
        )
        axes.imshow(picture, interpolation="nearest" if picture.shape[1] < 300 else "antialiased")
        axes.set_axis_off()
        axes.set_title(title, fontsize=11, color=_INK, pad=5)
    if maximum is not None:
        place = figure.add_axes(((across - bar + 0.04) / across, bottom / down, 0.14 / across, panel / down))
        scale = ScalarMappable(Normalize(0, maximum), COLOUR_MAP)
        colour_bar = figure.colorbar(scale, cax=place)
        colour_bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
        colour_bar.ax.tick_params(labelsize=9, length=2, color=_INK, labelcolor=_INK)
        place.set_title("px", fontsize=9, color=_INK, pad=5)
    if legend:
        _legend(figure, bottom / down, legend)
    file = io.BytesIO()
    canvas.print_png(file)
    return file.getvalue()


def _legend(figure: Figure, height: float, colours: Mapping[str, tuple[int, int, int]]) -> None:
    """One row of labelled colour patches along the bottom."""
    axes = figure.add_axes((0, 0, 1, height))
    axes.set_axis_off()
    for label, rgb in colours.items():
        shade = tuple(value / 255 for value in rgb)
        axes.scatter(
            [], [], marker="s", s=90, color=[shade], edgecolors="#8c959f", linewidths=0.5, label=label
        )
    axes.legend(loc="center", ncols=len(colours), frameon=False, fontsize=10, labelcolor=_INK)


def _mask(disparity: np.ndarray, mask: np.ndarray, what: str) -> np.ndarray:
    if disparity.ndim != 2 or mask.shape != disparity.shape:
        raise InputError(
            f"the disparity map has shape {disparity.shape}, the {what} {mask.shape}", "give both at one size"
        )
    return mask.astype(bool)
