"""Files of depth: PNG in millimetres, TIFF and PFM in metres, point clouds as PLY and ``.npz``."""

import io
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from plyfile import PlyData, PlyElement

from softdepth.files import write_atomically
from softdepth.golden.data.writers import write_pfm
from softdepth.metric.scene import Scene
from softdepth.rig.geometry import Floats
from softdepth.spec.errors import InputError

MILLIMETRES = np.iinfo(np.uint16).max
"""The farthest depth that a 16-bit PNG in millimetres holds: 65.535 m."""


def millimetres(depth: Floats) -> tuple[NDArray[np.uint16], int]:
    """Depth in whole millimetres, 0 for none, and how many lie beyond `MILLIMETRES`: these are 0 as well.

    A depth above 0 is at least 1 mm.
    """
    known = np.isfinite(depth)
    found = np.zeros(depth.shape)
    found[known] = np.maximum(np.rint(depth[known].astype(np.float64) * 1000), 1)
    beyond = found > MILLIMETRES
    found[beyond] = 0
    return found.astype(np.uint16), int(beyond.sum())


def write_depth_png(path: str | Path, depth: Floats) -> int:
    """Write depth as 16-bit PNG in `millimetres`, as most depth cameras do; returns how many lie beyond."""
    found, beyond = millimetres(depth)
    write_atomically(path, _encoded(".png", found))
    return beyond


def write_depth_tiff(path: str | Path, depth: Floats) -> None:
    """Write depth as 32-bit float TIFF in metres, NaN for none."""
    write_atomically(path, _encoded(".tiff", depth.astype(np.float32)))


def write_depth_pfm(path: str | Path, depth: Floats) -> None:
    """Write depth as PFM in metres; none is infinite, as in Middlebury's files."""
    write_pfm(path, depth, np.isfinite(depth))


def write_ply(path: str | Path, scene: Scene) -> int:
    """Write the points with a depth as binary PLY and return their number.

    Vertices have ``x``, ``y``, ``z`` in metres (left camera's optical frame), ``red``, ``green``, ``blue``
    where the left image is known, and ``filled``, which is 1 where the depth was filled in.
    """
    points, colours, filled = scene.points()
    fields = [(name, "<f4") for name in "xyz"]
    channels = () if colours is None else ("red", "green", "blue")
    fields += [(name, "u1") for name in (*channels, "filled")]
    vertices = np.empty(len(points), fields)
    for k, name in enumerate("xyz"):
        vertices[name] = points[:, k]
    if colours is not None:
        for k, name in enumerate(channels):
            vertices[name] = colours[:, k]
    vertices["filled"] = filled
    comments = [f"left camera's optical frame {scene.geometry.frame_id}: x right, y down, z ahead; metres"]
    file = io.BytesIO()
    PlyData([PlyElement.describe(vertices, "vertex")], byte_order="<", comments=comments).write(file)
    write_atomically(path, file.getvalue())
    return len(points)


def write_npz(path: str | Path, scene: Scene) -> None:
    """Write depth, points, colours, what was filled and the geometry as a compressed ``.npz``."""
    points, colours, filled = scene.points()
    geometry = scene.geometry
    arrays = {
        "depth": scene.depth,
        "points": points,
        "filled": filled,
        "focal": np.float64(geometry.focal),
        "baseline": np.float64(geometry.baseline),
        "doffs": np.float64(geometry.doffs),
        "principal_point": np.array([geometry.cx, geometry.cy]),
    }
    if colours is not None:
        arrays["colours"] = colours
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    write_atomically(path, file.getvalue())


def _encoded(suffix: str, image: np.ndarray) -> bytes:
    done, data = cv2.imencode(suffix, image)
    if not done:
        raise InputError(
            f"a {image.dtype} map of shape {image.shape} cannot be written as {suffix}", "give H x W"
        )
    return data.tobytes()
