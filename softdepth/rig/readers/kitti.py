"""KITTI's ``calib*.txt``: rectified images, projections with the baseline in metres times pixels."""

from pathlib import Path

from softdepth.rig.readers import keys
from softdepth.rig.rig import Rig
from softdepth.spec.errors import InputError

PAIRS = (("P_rect_02", "P_rect_03"), ("P_rect_00", "P_rect_01"), ("P2", "P3"), ("P0", "P1"))
"""The projections of the colour cameras, then of the gray ones, in raw data and in the benchmarks."""


def read(path: Path) -> Rig:
    """The rig of the colour cameras, else of the gray ones; raises `InputError` if neither is complete."""
    found = keys.lines(path, ":")
    for first, second in PAIRS:
        if first in found and second in found:
            left, right = (keys.floats(found, key, path, (3, 4)) for key in (first, second))
            size = None
            sizes = first.replace("P_rect", "S_rect")
            if sizes != first and sizes in found:
                width, height = keys.floats(found, sizes, path, (2,))
                size = (int(width), int(height))
            return Rig.of_rectified(left, right, size)
    wanted = " or ".join(f"'{first}' and '{second}'" for first, second in PAIRS)
    raise InputError(f"'{path}' has no keys {wanted}", "give a whole calibration")
