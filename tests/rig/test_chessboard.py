"""Real cameras: Debian's chessboard pictures, measured in metres (package opencv-doc; skipped without it).

OpenCV calibrates, as a user would; what is tested reads its files, rectifies, and gives the distances.
"""

from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.cli.app import main
from softdepth.golden.data.images import read_pair
from softdepth.rig.geometry import Geometry
from softdepth.rig.readers import any as readers
from softdepth.rig.rectify import Rectifier

FOLDER = Path("/usr/share/doc/opencv-doc/examples/data")
BOARD = (9, 6)
SIZE = (640, 480)
SQUARE = 0.025
"""The side of a square, in metres, as far as these pictures' users tell it; only ratios are tested."""

Pair = tuple[np.ndarray, np.ndarray]


def corners(view: np.ndarray) -> np.ndarray:
    """The inner corners, 54 x 1 x 2, to a fraction of a pixel."""
    found, rough = cv2.findChessboardCorners(view, BOARD)
    assert found
    end = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 100, 1e-5)
    return cv2.cornerSubPix(view, rough, (7, 7), (-1, -1), end)


@pytest.fixture(scope="module")
def pairs() -> list[Pair]:
    """Every pair of pictures, gray."""
    lefts = sorted(FOLDER.glob("left[0-9][0-9].jpg"))
    if not lefts:
        pytest.skip("no chessboard pictures: install Debian's opencv-doc")
    read = [read_pair(left, left.with_name(left.name.replace("left", "right"))) for left in lefts]
    return [(pair.left, pair.right) for pair in (each.as_format("gray8") for each in read)]


def calibrated(pairs: list[Pair], folder: Path) -> list[Path]:
    """OpenCV's calibration of these pairs, lengths in squares, in its two files."""
    board = np.zeros((BOARD[0] * BOARD[1], 3), np.float32)
    board[:, :2] = np.mgrid[: BOARD[0], : BOARD[1]].T.reshape(-1, 2)
    boards = [board] * len(pairs)
    views = [[corners(pair[side]) for pair in pairs] for side in (0, 1)]
    flags = cv2.CALIB_ZERO_TANGENT_DIST
    cameras = []
    for view in views:
        _, matrix, lens, _, _ = cv2.calibrateCamera(boards, view, SIZE, None, None, flags=flags)
        cameras += [matrix, lens]
    flags |= cv2.CALIB_USE_INTRINSIC_GUESS
    _, m1, d1, m2, d2, r, t, _, _ = cv2.stereoCalibrate(boards, *views, *cameras, SIZE, flags=flags)
    paths = [folder / "intrinsics.yml", folder / "extrinsics.yml"]
    contents = ({"M1": m1, "D1": d1, "M2": m2, "D2": d2}, {"R": r, "T": t})
    for path, matrices in zip(paths, contents, strict=True):
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
        for name, matrix in matrices.items():
            storage.write(name, matrix)
        storage.release()
    return paths


def sides(geometry: Geometry, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Each square's side in metres, the mean of its four, from its corners in the rectified views."""
    disparity = (left - right)[..., 0].astype(np.float64)
    return _sides(geometry, left, geometry.depth(disparity, np.ones(disparity.shape, bool)))


def _sides(geometry: Geometry, corners: np.ndarray, depths: np.ndarray) -> np.ndarray:
    places = corners.reshape(*BOARD[::-1], 2).astype(np.float64)
    depth = depths.reshape(*BOARD[::-1], 1).astype(np.float64)
    middle = np.array([geometry.cx, geometry.cy])
    points = np.concatenate([(places - middle) / geometry.focal * depth, depth], axis=-1)
    across, down = (np.linalg.norm(np.diff(points, axis=axis), axis=-1) for axis in (1, 0))
    return (across[:-1] + across[1:] + down[:, :-1] + down[:, 1:]) / 4


def test_squares_have_their_size_in_metres(pairs, tmp_path):
    rectifier = Rectifier.of(readers.read(calibrated(pairs[1::2], tmp_path), SQUARE), SIZE)
    errors, rows = [], []
    for pair in pairs[::2]:  # boards that the calibration has not seen
        left, right = map(corners, rectifier.apply(*pair))
        rows.append(np.abs(left - right)[..., 1])
        errors.append(np.abs(sides(rectifier.geometry, left, right) / SQUARE - 1))
    assert np.median(rows) < 0.25
    assert np.median(errors) < 0.0023


@pytest.mark.slow
def test_a_sequence_of_raw_pictures_measures_them_too(pairs, tmp_path):
    """Rectified and matched by the command; the depth of a corner is the median of those around it."""
    calibration = calibrated(pairs[1::2], tmp_path)
    rectify = [word for path in calibration for word in ("--rectify", path)]
    chosen = [f"--set={each}" for each in ("disparities=128", "min_disparity=84", "criteria.0.window=9")]
    out = tmp_path / "out"
    views = [FOLDER / f"{side}0[13].jpg" for side in ("left", "right")]  # what the calibration has not seen
    command = ["sequence", *views, *rectify, "--unit", SQUARE, "--preset", "sad", *chosen]
    assert main([*map(str, command), "--processes", "1", "-o", str(out)]) == 0
    rectification = readers.read([out / "calibration.yml"]).rectification
    assert rectification is not None
    errors = []
    for name in ("left01", "left03"):
        place = out / "frames" / name
        left = cv2.imread(str(place / "left.png"), cv2.IMREAD_GRAYSCALE)
        depth = cv2.imread(str(place / "depth.tiff"), cv2.IMREAD_UNCHANGED)
        assert left is not None
        assert depth is not None
        found = corners(left)
        places = np.rint(found.reshape(-1, 2)).astype(int)
        depths = np.array([np.nanmedian(depth[y - 4 : y + 5, x - 4 : x + 5]) for x, y in places])
        errors.append(np.abs(_sides(rectification.geometry, found, depths) / SQUARE - 1))
    assert np.median(errors) < 0.01
