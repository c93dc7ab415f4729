"""OpenCV's two classical matchers, for scale."""

from typing import Any

import cv2
import numpy as np

from softdepth.studies.paper.readings import Method, Reading

FRACTION = 16
"""OpenCV's units per pixel of disparity."""

PARAMETERS: dict[Method, dict[str, Any]] = {
    "stereobm": {"blockSize": 15},
    "stereosgbm": {
        "minDisparity": 0,
        "blockSize": 5,
        "P1": 8 * 3 * 5**2,
        "P2": 32 * 3 * 5**2,
        "disp12MaxDiff": 1,
        "uniquenessRatio": 10,
        "speckleWindowSize": 100,
        "speckleRange": 2,
        "mode": cv2.STEREO_SGBM_MODE_SGBM,
    },
}
"""StereoBM as it comes; SGBM with the penalties of OpenCV's own sample, five directions, RGB."""

TITLES: dict[Method, str] = {"stereobm": "OpenCV StereoBM", "stereosgbm": "OpenCV SGBM"}


def disparity(left: np.ndarray, right: np.ndarray, reading: Reading) -> tuple[np.ndarray, np.ndarray]:
    """Disparities in pixels (H x W float32, 1/16 px), and where there is a result."""
    if reading.view == "right":
        left, right = right[:, ::-1], left[:, ::-1]
    left, right = (np.ascontiguousarray(image) for image in (left, right))
    parameters = {"numDisparities": reading.candidates, **PARAMETERS[reading.method]}
    if reading.method == "stereobm":
        left, right = (cv2.cvtColor(image, cv2.COLOR_RGB2GRAY) for image in (left, right))
        raw = cv2.StereoBM.create(**parameters).compute(left, right)
    else:
        raw = cv2.StereoSGBM.create(**parameters).compute(left, right)
    found = raw.astype(np.float32) / FRACTION
    if reading.view == "right":
        found = found[:, ::-1]
    return np.maximum(found, 0), found >= 0


def parameters_text(method: Method) -> str:
    """The parameters as ``key=value``, for reports."""
    return ", ".join(f"{key}={value}" for key, value in PARAMETERS[method].items())
