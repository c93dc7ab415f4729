"""Written files: they read back, and a failed write leaves nothing behind."""

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.files import write_atomically
from softdepth.golden.data.truth import read_truth
from softdepth.golden.data.writers import write_disparity_png, write_pfm, write_picture
from softdepth.spec.errors import InputError
from tests.support.images import read_image

MAP = np.array([[0, 1, 2.5], [63, 200, 255]], np.float32)
VALID = np.array([[True, True, False], [True, False, True]])


def test_pfm_round_trip(tmp_path: Path) -> None:
    write_pfm(path := tmp_path / "map.pfm", MAP, VALID)
    raw = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(raw, np.where(VALID, MAP, np.inf))
    np.testing.assert_array_equal(read_truth(path).disparity, np.where(VALID, MAP, np.nan))


def test_png_round_trip(tmp_path: Path) -> None:
    write_disparity_png(path := tmp_path / "map.png", MAP, VALID)
    raw = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert raw is not None
    # A valid 0 is 1/256 px, as in KITTI's tools: only no result is 0.
    np.testing.assert_array_equal(raw, [[1, 256, 0], [63 * 256, 0, 255 * 256]])
    assert raw.dtype == np.uint16
    back = read_truth(path)
    np.testing.assert_array_equal(back.known, VALID)
    assert np.abs(np.where(VALID, back.disparity - MAP, 0)).max() <= 1 / 256


def test_integer_map_without_a_mask(tmp_path: Path) -> None:
    disparity = np.arange(1, 13, dtype=np.uint16).reshape(3, 4)
    for write, name in ((write_pfm, "map.pfm"), (write_disparity_png, "map.png")):
        write(tmp_path / name, disparity)
        np.testing.assert_array_equal(read_truth(tmp_path / name).disparity, disparity)


@pytest.mark.parametrize("write", [write_pfm, write_disparity_png])
def test_not_finite_is_no_result(tmp_path: Path, write: Callable[[Path, np.ndarray], None]) -> None:
    write(path := tmp_path / "map", np.array([[np.nan, np.inf, 7]]))
    np.testing.assert_array_equal(read_truth(path).disparity, [[np.nan, np.nan, 7]])


def test_picture_round_trip(tmp_path: Path, picture: np.ndarray) -> None:
    write_picture(path := tmp_path / "p.png", picture)
    np.testing.assert_array_equal(read_image(path)[0], picture)


@pytest.mark.parametrize("worst", [256, -1])
def test_png_range(tmp_path: Path, worst: float) -> None:
    with pytest.raises(InputError, match=f"disparity {worst} does not fit"):
        write_disparity_png(tmp_path / "map.png", np.array([[1, worst]]))
    assert list(tmp_path.iterdir()) == []


def test_wrong_shapes(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="shape"):
        write_pfm(tmp_path / "a", np.zeros((2, 2, 3)))
    with pytest.raises(InputError, match="valid mask"):
        write_pfm(tmp_path / "a", MAP, VALID[:1])
    with pytest.raises(InputError, match="the picture is float64"):
        write_picture(tmp_path / "a", np.zeros((2, 2, 3)))
    assert list(tmp_path.iterdir()) == []


def test_replaces_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"old")
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        write_atomically(path, b"new")
    assert "\n" not in str(caught.value)
    assert caught.value.remedy
    return caught.value.problem


def test_folder_is_missing(tmp_path: Path) -> None:
    assert f"folder '{tmp_path / 'none'}' does not exist" in refused(tmp_path / "none" / "a")


def test_folder_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    assert "part of the path is a file" in refused(tmp_path / "file" / "a")


def test_path_is_a_folder(tmp_path: Path) -> None:
    assert "is a folder" in refused(tmp_path)


@pytest.mark.parametrize("step", ["write_bytes", "replace"])
@pytest.mark.parametrize(
    "error", [PermissionError(13, "Permission denied"), OSError(28, "No space left on device")]
)
def test_failure_leaves_the_old_file_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str, error: OSError
) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"old")

    def fail(self: Path, *_: object) -> None:
        if step == "write_bytes":
            with self.open("wb") as file:
                file.write(b"ne")
        raise error

    monkeypatch.setattr(Path, step, fail)
    assert str(error.strerror) in refused(path)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
