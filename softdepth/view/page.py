"""One HTML page that holds a result: pictures, and a point cloud to turn with the mouse. It loads nothing."""

import base64
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import plotly.graph_objects as go
import plotly.io
from numpy.typing import NDArray
from PIL import Image

from softdepth.golden.score.pictures import colour
from softdepth.metric.scene import Scene
from softdepth.templates import render

MAX_POINTS = 100_000
"""Points that a browser without a graphics card still turns smoothly; more are thinned out."""

COLOURS = 256
"""Colours of the cloud: a palette of the left image's, so that a point takes a byte and not a word."""

NEAR_FAR = (2, 98)
"""Per cent of the depths between which the picture's colours spread: a few outliers do not count."""


@dataclass(frozen=True)
class Panel:
    """A picture of the page: its title, its PNG as text, what to know about it."""

    title: str
    png: str
    caption: str


def page(
    title: str, scene: Scene, confidence: NDArray[np.uint8] | None = None, facts: tuple[str, ...] = ()
) -> str:
    """The page's text: left image, depth, confidence where there is one, and the points.

    Parameters
    ----------
    title : what the pair is called.
    scene : depth, and the left image where it is known.
    confidence : H x W, 0 to 255.
    facts : lines to show above the pictures: preset, share of pixels with a depth, ...
    """
    panels = []
    if scene.image is not None:
        panels.append(Panel("Left image", _png(scene.image), ""))
    near, far = limits(scene)
    panels.append(
        Panel(
            "Depth",
            _png(_colours(scene.depth, near, far)),
            f"{near:.2f} m (red) to {far:.2f} m (blue); black: none",
        )
    )
    if confidence is not None:
        gray = np.repeat(confidence[..., None], 3, axis=2)
        panels.append(Panel("Confidence", _png(gray), "white: sure; black: filled in, or none"))
    points, palette, _ = scene.points()
    shown = min(len(points), MAX_POINTS)
    return render(
        "softdepth.view",
        "view.html",
        title=title,
        facts=facts,
        panels=panels,
        cloud=_cloud(points, palette),
        points=len(points),
        shown=shown,
        frame_id=scene.geometry.frame_id,
    )


def limits(scene: Scene) -> tuple[float, float]:
    """The depths in metres that the picture's colours spread between; 0 and 1 where there is no depth."""
    known = scene.depth[np.isfinite(scene.depth)]
    if not known.size:
        return 0.0, 1.0
    near, far = (float(value) for value in np.percentile(known, NEAR_FAR))
    return near, max(far, near * 1.01)


def _colours(depth: np.ndarray, near: float, far: float) -> NDArray[np.uint8]:
    # Evenly over the inverse, as disparities are: near things keep their shapes.
    known = np.isfinite(depth)
    level = np.zeros(depth.shape)
    inverse = 1 / np.clip(depth[known], near, far)
    level[known] = (inverse - 1 / far) / (1 / near - 1 / far) if near else 0
    return colour(level, known, 1.0)


def _cloud(points: np.ndarray, colours: np.ndarray | None) -> str:
    """The point cloud as a division of the page, plotly's script in it."""
    step = max(1, -(-len(points) // MAX_POINTS))
    points = points[::step]
    marker: dict[str, Any] = {"size": 1.6, "showscale": False}
    if colours is not None and len(points):
        strip = Image.fromarray(np.ascontiguousarray(colours[::step])[None])
        palette = strip.quantize(COLOURS, dither=Image.Dither.NONE)
        table = np.array(palette.getpalette(), np.uint8).reshape(-1, 3)
        last = max(len(table) - 1, 1)
        scale = [[k / last, "rgb({},{},{})".format(*rgb)] for k, rgb in enumerate(table)]
        marker |= {"color": np.asarray(palette)[0], "cmin": 0, "cmax": last}
        marker["colorscale"] = scale if len(scale) > 1 else [[0, scale[0][1]], [1, scale[0][1]]]
    else:
        marker |= {"color": points[:, 2], "colorscale": "Turbo", "reversescale": True}
    # Upright for the eye: x to the right, z away, y up.
    trace = go.Scatter3d(x=points[:, 0], y=points[:, 2], z=-points[:, 1], mode="markers", marker=marker)
    figure = go.Figure(trace)
    figure.update_traces(hovertemplate="x %{x:.3f} m, z %{y:.3f} m, y %{z:.3f} m up<extra></extra>")
    figure.update_layout(
        margin={"l": 0, "r": 0, "t": 0, "b": 0},
        height=600,
        scene={
            "aspectmode": "data",
            "xaxis_title": "x, m",
            "yaxis_title": "z, m",
            "zaxis_title": "up, m",
            "camera": {"eye": {"x": 0.0, "y": -1.6, "z": 0.5}},
        },
    )
    return plotly.io.to_html(figure, full_html=False, include_plotlyjs=True, div_id="cloud")


def _png(image: NDArray[np.uint8]) -> str:
    _, data = cv2.imencode(".png", np.ascontiguousarray(image[..., ::-1]))
    return base64.b64encode(data.tobytes()).decode()
