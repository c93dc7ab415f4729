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
    if all(name in found for name in ("R1", "R2", "P1", "P2")):
        turns = [keys.numbers(found, name, path, (3, 3)) for name in ("R1", "R2")]
        views = [keys.numbers(found, name, path, (3, 4)) for name in ("P1", "P2")]
        for view in views:
            view[:, 3] *= unit
        if "M1" not in found and "R" not in found:
            return Rig.of_rectified(views[0], views[1], size)
        rectification = Rectification((turns[0], turns[1]), (views[0], views[1]))
    matrices = (keys.numbers(found, name, path, (3, 3)) for name in ("M1", "M2"))
    lenses = (keys.numbers(found, name, path, (-1,)) for name in ("D1", "D2"))
    left, right = (Camera(matrix, lens, size=size) for matrix, lens in zip(matrices, lenses, strict=True))
    rotation = keys.numbers(found, "R", path, (3, 3))
    return Rig(left, right, rotation, unit * keys.numbers(found, "T", path, (3,)), rectification)


def _matrices(path: Path) -> dict[str, Matrix]:
    text = keys.text(path)
    try:
        with quiet():
            return _parsed(text)
    except (cv2.error, SystemError) as error:
        remedy = "name an undamaged YAML or XML file of OpenCV's"
        raise InputError(f"'{path}' is no OpenCV calibration", remedy) from error


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
