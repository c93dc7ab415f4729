"""ROS 2's ``camera_info`` YAML, one file a camera; the baseline is in the right projection, in metres."""

from pathlib import Path

from softdepth.rig.camera import Camera, Lens, Matrix
from softdepth.rig.readers import keys
from softdepth.rig.rig import Rectification, Rig
from softdepth.spec.errors import InputError

LENSES: dict[str, Lens] = {
    "plumb_bob": "radtan",
    "rational_polynomial": "radtan",
    "equidistant": "equidistant",
    "fisheye": "equidistant",
}


def read(left: Path, right: Path) -> Rig:
    """The rig of two files; raises `InputError` that names a key which is missing or wrong.

    Their rectification gives the baseline, and with it the cameras' placement.
    """
    (one, r1, p1), (two, r2, p2) = _camera(left), _camera(right)
    found = Rectification((r1, r2), (p1, p2))
    return Rig(one, two, *found.between, found)


def _camera(path: Path) -> tuple[Camera, Matrix, Matrix]:
    found = keys.parse_yaml(path)
    matrix = keys.numbers(found, "camera_matrix.data", path, (3, 3))
    model = keys.value(found, "distortion_model", path)
    if model not in LENSES:
        raise InputError(f"distortion_model in '{path}' is '{model}'", f"use one of {', '.join(LENSES)}")
    distortion = keys.numbers(found, "distortion_coefficients.data", path, (-1,))
    sides = [int(keys.numbers(found, key, path, (1,))[0]) for key in ("image_width", "image_height")]
    camera = Camera(matrix, distortion, LENSES[model], (sides[0], sides[1]))
    rotation = keys.numbers(found, "rectification_matrix.data", path, (3, 3))
    return camera, rotation, keys.numbers(found, "projection_matrix.data", path, (3, 4))
