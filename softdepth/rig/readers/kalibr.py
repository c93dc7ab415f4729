"""Kalibr's camchain YAML: ``cam0`` is the left camera, ``cam1`` the right one, lengths in metres."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softdepth.rig.camera import Camera, Lens
from softdepth.rig.readers import keys
from softdepth.rig.rig import Rig
from softdepth.spec.errors import InputError

LENSES: dict[str, Lens] = {"radtan": "radtan", "equidistant": "equidistant"}


def read(path: Path) -> Rig:
    """The rig of a camchain; raises `InputError` that names a key which is missing or wrong."""
    found = keys.parse_yaml(path)
    left, right = (_camera(found, name, path) for name in ("cam0", "cam1"))
    step = keys.numbers(found, "cam1.T_cn_cnm1", path, (4, 4))
    return Rig(left, right, step[:3, :3], step[:3, 3])


def _camera(found: Mapping[str, Any], name: str, path: Path) -> Camera:
    model = keys.value(found, f"{name}.camera_model", path)
    if model != "pinhole":
        raise InputError(f"camera_model of {name} in '{path}' is '{model}'", "calibrate it as pinhole")
    lens = keys.value(found, f"{name}.distortion_model", path)
    if lens not in LENSES:
        raise InputError(
            f"distortion_model of {name} in '{path}' is '{lens}'", f"use one of {', '.join(LENSES)}"
        )
    fx, fy, cx, cy = keys.numbers(found, f"{name}.intrinsics", path, (4,))
    width, height = keys.numbers(found, f"{name}.resolution", path, (2,)).astype(int)
    return Camera(
        np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]),
        keys.numbers(found, f"{name}.distortion_coeffs", path, (-1,)),
        LENSES[lens],
        (int(width), int(height)),
    )
