"""The files of a frame in metres, written together."""

from pathlib import Path

from softdepth.metric import writers
from softdepth.metric.scene import Scene

UNCERTAINTY = "uncertainty.tiff"
FILES = ("depth.png", "depth.tiff", "depth.pfm", "cloud.ply", "cloud.npz", UNCERTAINTY)
"""The names in the folder; the last where the disparity's error is known."""


def write(folder: Path, scene: Scene, disparity_error: float | None = None) -> tuple[int, tuple[str, ...]]:
    """Write a scene into a folder: the number of its points, and notes for the user.

    `disparity_error` is the standard error of a disparity in pixels, from which each depth gets its own.
    """
    notes = ()
    if beyond := writers.write_depth_png(folder / "depth.png", scene.depth):
        notes = (f"depth.png: {beyond} pixels beyond 65.5 m have no depth there; depth.tiff has them",)
    writers.write_depth_tiff(folder / "depth.tiff", scene.depth)
    writers.write_depth_pfm(folder / "depth.pfm", scene.depth)
    if disparity_error is not None:
        spread = scene.geometry.uncertainty(scene.depth, disparity_error)
        writers.write_depth_tiff(folder / UNCERTAINTY, spread)
    points = writers.write_ply(folder / "cloud.ply", scene)
    writers.write_npz(folder / "cloud.npz", scene)
    return points, notes
