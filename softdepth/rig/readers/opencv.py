"""OpenCV's YAML, XML or JSON, as its stereo calibration writes it: one file, or intrinsics and extrinsics."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from softdepth.golden.data.decode import quiet
from softdepth.rig.camera import Camera, Matrix
from softdepth.rig.readers import keys
from softdepth.rig.rig import Rectification, Rig
from softdepth.spec.errors import InputError

NAMES: dict[str, tuple[str, ...]] = {
    "M1": ("M1", "K1", "cameraMatrix1", "camera_matrix_1"),
    "D1": ("D1", "distCoeffs1", "dist_coeffs_1"),
    "M2": ("M2", "K2", "cameraMatrix2", "camera_matrix_2"),
    "D2": ("D2", "distCoeffs2", "dist_coeffs_2"),
    "R": ("R",),
    "T": ("T",),
    "R1": ("R1",),
    "R2": ("R2",),
    "P1": ("P1",),
    "P2": ("P2",),
    "Q": ("Q",),
}
"""The names of OpenCV's sample first, then what other programs call them."""


def read(paths: Sequence[Path], unit: float) -> Rig:
    """The rig of one or two files, whose lengths are in units of `unit` metres.

    OpenCV's lengths are in what the chessboard's squares were given in: 0.001 for millimetres.

    Raises `InputError` that names a key which is missing or wrong.
    """
    found: dict[str, Matrix] = {}
    for path in paths:
        found |= _matrices(path)
    path = paths[0] if len(paths) == 1 else Path(" and ".join(map(str, paths)))
    size = None
    if "size" in found:
        width, height = keys.numbers(found, "size", path, (2,)).astype(int)
        size = (int(width), int(height))
    rectification = None
    raw = any(name in found for name in ("M1", "M2", "R"))
    if "P1" in found and "P2" in found:
        views = [keys.numbers(found, name, path, (3, 4)) * (1, 1, 1, unit) for name in ("P1", "P2")]
        if not raw:
            return Rig.of_rectified(views[0], views[1], size)
        if "R1" in found and "R2" in found:
            turns = [keys.numbers(found, name, path, (3, 3)) for name in ("R1", "R2")]
            rectification = Rectification((turns[0], turns[1]), (views[0], views[1]))
    elif "Q" in found and not raw:
        return Rig.of_rectified(*_projections(keys.numbers(found, "Q", path, (4, 4)), path, unit), size)
    if not found.keys() - {"size"}:
        raise InputError(f"'{path}' has no key 'M1', 'P1' or 'Q'", "give a whole calibration")
    matrices = (keys.numbers(found, name, path, (3, 3)) for name in ("M1", "M2"))
    lenses = (keys.numbers(found, name, path, (-1,)) for name in ("D1", "D2"))
    left, right = (Camera(matrix, lens, size=size) for matrix, lens in zip(matrices, lenses, strict=True))
    if rectification is not None and "R" not in found:
        return Rig(left, right, *rectification.between, rectification)
    rotation = keys.numbers(found, "R", path, (3, 3))
    return Rig(left, right, rotation, unit * keys.numbers(found, "T", path, (3,)), rectification)


def _projections(q: Matrix, path: Path, unit: float) -> tuple[Matrix, Matrix]:
    """The projections that `cv2.stereoRectify` made its Q of; raises `InputError` if it is none."""
    focal, per_baseline = q[2, 3], q[3, 2]
    if focal <= 0 or per_baseline <= 0:
        raise InputError(
            f"'Q' in '{path}' has a focal length of {focal:g} and 1 / baseline of {per_baseline:g}",
            "give the Q of cameras side by side, the left one first",
        )
    left, right = (np.array([[focal, 0, -q[0, 3], 0], [0, focal, -q[1, 3], 0], [0, 0, 1, 0.0]]) for _ in "lr")
    right[0, 2] += q[3, 3] / per_baseline
    right[0, 3] = -focal * unit / per_baseline
    return left, right


def _matrices(path: Path) -> dict[str, Matrix]:
    text = keys.text(path)
    try:
        with quiet():
            return _parsed(text)
    except (cv2.error, SystemError) as error:
        remedy = "name an undamaged YAML or XML file of OpenCV's"
        raise InputError(f"'{path}' is not an OpenCV calibration", remedy) from error


def _parsed(text: str) -> dict[str, Matrix]:
    storage = cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
    found: dict[str, Matrix] = {}
    for key, names in NAMES.items():
        node = next((node for node in map(storage.getNode, names) if not node.empty()), None)
        matrix = None if node is None else node.mat()
        if matrix is not None:
            found[key] = np.asarray(matrix, np.float64)
    sizes = [storage.getNode(name) for name in ("image_width", "image_height")]
    if not any(node.empty() for node in sizes):
        found["size"] = np.array([node.real() for node in sizes])
    storage.release()
    return found
