"""A raw rig with known numbers, its files as other tools write them, and pictures through its lenses."""

from pathlib import Path

import cv2
import numpy as np

from softdepth.rig.camera import Camera
from softdepth.rig.rig import Rig

SIZE = (320, 240)
LEFT = np.array([[300.0, 0, 158], [0, 301, 121], [0, 0, 1]])
RIGHT = np.array([[298.0, 0, 163], [0, 299, 117], [0, 0, 1]])
LEFT_LENS = np.array([-0.12, 0.03, 0.001, -0.0005, 0.0])
RIGHT_LENS = np.array([-0.10, 0.02, -0.001, 0.0007, 0.0])
ROTATION = cv2.Rodrigues(np.array([0.01, -0.02, 0.015]))[0]
TRANSLATION = np.array([-0.12, 0.002, 0.001])


def rig() -> Rig:
    """The rig itself, in metres."""
    left, right = (Camera(m, d, size=SIZE) for m, d in ((LEFT, LEFT_LENS), (RIGHT, RIGHT_LENS)))
    return Rig(left, right, ROTATION, TRANSLATION)


def opencv(path: Path, unit: float = 1.0, leave_out: str = "", size: bool = True) -> Path:
    """The rig as OpenCV's sample writes it, lengths in `unit` metres."""
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    if size:
        storage.write("image_width", SIZE[0])
        storage.write("image_height", SIZE[1])
    all_of_it = {
        "M1": LEFT, "D1": LEFT_LENS, "M2": RIGHT, "D2": RIGHT_LENS, "R": ROTATION, "T": TRANSLATION / unit,
    }  # fmt: skip
    for key, value in all_of_it.items():
        if key != leave_out:
            storage.write(key, value)
    storage.release()
    return path


def kalibr(path: Path) -> Path:
    """The rig as a camchain."""
    step = np.eye(4)
    step[:3, :3], step[:3, 3] = ROTATION, TRANSLATION
    lines: list[str] = []
    for name, m, d in (("cam0", LEFT, LEFT_LENS), ("cam1", RIGHT, RIGHT_LENS)):
        lines += [
            f"{name}:",
            "  camera_model: pinhole",
            f"  intrinsics: [{m[0, 0]}, {m[1, 1]}, {m[0, 2]}, {m[1, 2]}]",
            "  distortion_model: radtan",
            f"  distortion_coeffs: {d[:4].tolist()}",
            f"  resolution: [{SIZE[0]}, {SIZE[1]}]",
        ]
    lines.append("  T_cn_cnm1:")
    lines += [f"  - {row.tolist()}" for row in step]
    path.write_text("\n".join(lines) + "\n")
    return path


def camera_info(path: Path, matrix, lens, rotation, projection) -> Path:
    """One camera as ROS' calibrator writes it."""

    def block(name: str, array, rows: int, columns: int) -> str:
        data = ", ".join(repr(float(value)) for value in np.ravel(array))
        return f"{name}:\n  rows: {rows}\n  cols: {columns}\n  data: [{data}]\n"

    path.write_text(
        f"image_width: {SIZE[0]}\nimage_height: {SIZE[1]}\ncamera_name: c\n"
        + block("camera_matrix", matrix, 3, 3)
        + "distortion_model: plumb_bob\n"
        + block("distortion_coefficients", lens, 1, 5)
        + block("rectification_matrix", rotation, 3, 3)
        + block("projection_matrix", projection, 3, 4)
    )
    return path


def seen_raw(view: np.ndarray, camera: Camera, rotation: np.ndarray, projection: np.ndarray) -> np.ndarray:
    """What the raw camera sees of a picture that is `view` once rectified."""
    width, height = SIZE
    grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).astype(np.float32)
    straight = cv2.undistortPoints(
        grid.reshape(-1, 1, 2), camera.matrix, camera.distortion, R=rotation, P=projection
    ).reshape(height, width, 2)
    return cv2.remap(
        view, straight.astype(np.float32), None, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
