"""Which tool wrote a calibration, told from its contents."""

from collections.abc import Sequence
from pathlib import Path

from softdepth.rig.readers import kalibr, keys, kitti, middlebury, opencv, ros
from softdepth.rig.rig import Rig
from softdepth.spec.errors import InputError


def read(paths: Sequence[Path], unit: float = 1.0) -> Rig:
    """The rig of one or two calibration files; `unit` is OpenCV's, in metres (`readers.opencv`).

    Raises `InputError` for a kind that is not known, more or fewer files than it has, or wrong contents.
    """
    if not 1 <= len(paths) <= 2:
        raise InputError(f"{len(paths)} calibration files", "give one, or two where each camera has its own")
    text = keys.text(paths[0])
    if "%YAML:1.0" in text or "opencv-matrix" in text or "opencv_storage" in text:
        return opencv.read(paths, unit)
    if "camera_matrix" in text:
        if len(paths) == 1:
            raise InputError(
                f"'{paths[0]}' is one camera's camera_info", "give the right camera's file as well"
            )
        return ros.read(paths[0], paths[1])
    if len(paths) == 2:
        raise InputError(f"'{paths[1]}' is a second file", "only OpenCV and ROS calibrations have two")
    if "cam0=" in text.replace(" ", ""):
        return middlebury.read(paths[0])
    if "cam0:" in text:
        return kalibr.read(paths[0])
    if any(f"{first}:" in text for first, _ in kitti.PAIRS):
        return kitti.read(paths[0])
    raise InputError(
        f"'{paths[0]}' is not a calibration of a known form",
        "give one of OpenCV, ROS (camera_info), Middlebury (calib.txt), KITTI or Kalibr (camchain)",
    )
