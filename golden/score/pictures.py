"""Pictures of disparity maps: in colour, against the truth, and side by side."""

import io
from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from PIL import Image

from softdepth.golden.data.truth import Truth
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

Colour = tuple[int, int, int]

COLOUR_MAP = ListedColormap(
    matplotlib.colormaps["turbo"](np.linspace(0.1, 1, 256)), "turbo without its darkest"
)
"""Blue is far, red is near. The dark violet end is left out, so that far is nowhere near `NO_RESULT`."""

NO_RESULT = (24, 24, 27)
"""The colour of pixels without a result: near black."""

_SHADES: dict[Validity, tuple[float, int]] = {Validity.PARTIAL: (0.55, 255), Validity.FILLED: (0.5, 128)}
"""What a disparity's colour is mixed with, and how much, where it is not a full measurement."""

CODE_COLOURS: dict[Validity, Colour] = {
    Validity.FULL: (0, 114, 178),
    Validity.PARTIAL: (86, 180, 233),
    Validity.BORDER: NO_RESULT,
    Validity.FILLED: (240, 228, 66),
    Validity.INCONSISTENT: (213, 94, 0),
    Validity.ISLAND: (204, 121, 167),
    Validity.NOTHING: (150, 150, 150),
}
"""The palette of `code_picture`: Okabe and Ito's colours, which the colour-blind tell apart too."""

ERROR_COLOURS: dict[str, Colour] = {
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

ERROR_INCHES, ERROR_PIXELS = 7.2, 900
"""Width of `error_figure`, on paper and about in pixels: its legend takes that much."""


def colour_range(disparity: np.ndarray, valid: np.ndarray) -> tuple[float, float]:
    """The smallest and the largest disparity worth a colour of their own: whole pixels, never equal.

    One in two hundred of the valid pixels may lie beyond either end, so that a few wrong ones do not take
    the colours away from the rest.
    """
    shown = disparity[_mask(disparity, valid, "valid mask") & np.isfinite(disparity)]
    if not shown.size:
        return 0.0, 1.0
    low, high = np.percentile(shown, (0.5, 99.5))
    return float(np.floor(low)), float(max(np.ceil(high), np.floor(low) + 1))


def colour(
    disparity: np.ndarray,
    valid: np.ndarray,
    maximum: float,
    *,
    minimum: float = 0,
    code: np.ndarray | None = None,
) -> np.ndarray:
    """A map of disparities (pixels, H x W) in colour: uint8 RGB, H x W x 3.

    `minimum` and less is blue, `maximum` and more dark red; pixels that are not `valid` are `NO_RESULT`.
    With the validity `code` of each pixel (H x W), those of which only part of the range was compared are
    paler, and filled ones grayer. Give maps that are to be compared the same range.

    Raises
    ------
    InputError : an empty range, or a mask of another shape.
    """
    if not maximum > minimum:
        raise InputError(
            f"the maximum disparity is {maximum}, the minimum {minimum}", "give a larger maximum, in pixels"
        )
    valid = _mask(disparity, valid, "valid mask") & np.isfinite(disparity)
    scaled = (np.where(valid, disparity, minimum) - minimum) / (maximum - minimum)
    picture = COLOUR_MAP(np.clip(scaled, 0, 1), bytes=True)[:, :, :3].copy()
    if code is not None:
        for kind in _SHADES:
            picture[code == kind] = _shaded(picture[code == kind], kind)
    picture[~valid] = NO_RESULT
    return picture


def code_picture(code: np.ndarray) -> bytes:
    """The validity codes of a frame (H x W) as PNG with a palette: a pixel's value is its code, shown in
    `CODE_COLOURS`."""
    image = Image.fromarray(code.astype(np.uint8), "P")
    palette = np.zeros((max(CODE_COLOURS) + 1, 3), np.uint8)
    for kind, rgb in CODE_COLOURS.items():
        palette[kind] = rgb
    image.putpalette(palette.tobytes())
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()


def _shaded(rgb: np.ndarray, kind: Validity) -> np.ndarray:
    share, towards = _SHADES[kind]
    return np.rint((1 - share) * rgb + share * towards).astype(np.uint8)


def _map_legend(code: np.ndarray, valid: np.ndarray, middle: np.ndarray) -> dict[str, Colour]:
    """What the shades of `colour` mean, as far as they occur; `middle` is the sample to shade."""
    legend: dict[str, Colour] = {}
    names = {Validity.PARTIAL: "paler: part of the range", Validity.FILLED: "grayer: filled"}
    for kind, text in names.items():
        if (code == kind).any():
            red, green, blue = (int(value) for value in _shaded(middle, kind))
            legend[text] = (red, green, blue)
    if not valid.all():
        legend["no result"] = NO_RESULT
    return legend


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
    middle = np.array(COLOUR_MAP(0.3, bytes=True)[:3])
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
        scale = ScalarMappable(Normalize(minimum, maximum), COLOUR_MAP)
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


def _mask(disparity: np.ndarray, mask: np.ndarray, what: str) -> np.ndarray:
    if disparity.ndim != 2 or mask.shape != disparity.shape:
        raise InputError(
            f"the disparity map has shape {disparity.shape}, the {what} {mask.shape}", "give both at one size"
        )
    return mask.astype(bool)
