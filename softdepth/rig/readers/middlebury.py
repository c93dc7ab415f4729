"""Middlebury's ``calib.txt``: rectified images, baseline in millimetres, ``doffs`` in pixels."""

from pathlib import Path

import numpy as np

from softdepth.rig.readers import keys
from softdepth.rig.rig import Rig


def read(path: Path) -> Rig:
    """The rig of a ``calib.txt``; raises `InputError` that names a key which is missing or wrong."""
    found = keys.lines(path, "=")
    left = keys.floats(found, "cam0", path, (3, 3))
    right = keys.floats(found, "cam1", path, (3, 3))
    baseline = keys.floats(found, "baseline", path, (1,))[0] / 1000
    size = None
    if "width" in found and "height" in found:
        width, height = (int(keys.floats(found, key, path, (1,))[0]) for key in ("width", "height"))
        size = (width, height)
    if "doffs" in found:  # rounded to a thousandth in the file, like the matrices: they agree or doffs counts
        right[0, 2] = left[0, 2] + keys.floats(found, "doffs", path, (1,))[0]
    shift = np.array([[-right[0, 0] * baseline], [0.0], [0.0]])
    return Rig.of_rectified(np.hstack([left, np.zeros((3, 1))]), np.hstack([right, shift]), size)
