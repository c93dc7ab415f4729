"""Image files: every format comes in exactly, every bad file is refused in one line."""

import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden.data.decode import MAX_SIDE
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.pair import StereoPair
from softdepth.spec.errors import InputError
from tests.golden.conftest import save
from tests.support.images import read_image


@pytest.mark.parametrize("suffix", [".png", ".ppm", ".tiff"])
def test_lossless_formats_are_exact(tmp_path: Path, picture: np.ndarray, suffix: str) -> None:
    image, notes, bits = read_image(save(tmp_path / f"left{suffix}", picture))
    np.testing.assert_array_equal(image, picture)
    assert image.dtype == np.uint8
    assert (notes, bits) == ((), 8)


def test_jpeg_is_close(tmp_path: Path) -> None:
    ramp = np.dstack([np.tile(np.arange(0, 256, 4, dtype=np.uint8), (48, 1))] * 3)
    ramp[:, :, 0] //= 2
    image = read_image(save(tmp_path / "left.jpg", ramp)).pixels
    assert np.abs(image.astype(int) - ramp).max() < 12


@pytest.mark.parametrize("suffix", [".png", ".pgm"])
def test_gray_stays_gray(tmp_path: Path, picture: np.ndarray, suffix: str) -> None:
    gray = picture[:, :, 0]
    image, notes, _ = read_image(save(tmp_path / f"left{suffix}", gray))
    np.testing.assert_array_equal(image, gray)
    assert notes == ()


def test_alpha_is_dropped_with_a_note(tmp_path: Path, picture: np.ndarray) -> None:
    image, notes, _ = read_image(save(tmp_path / "left.png", np.dstack([picture, picture[:, :, 1]])))
    np.testing.assert_array_equal(image, picture)
    assert notes == ("left.png has an alpha channel: it is dropped",)


def test_orientation_tag_is_ignored(tmp_path: Path, picture: np.ndarray) -> None:
    """A camera's rotation tag must not turn one view of a rectified pair."""
    path = save(tmp_path / "left.jpg", picture)
    exif = b"Exif\0\0MM\0*\0\0\0\x08" + struct.pack(">HHHIHHI", 1, 0x0112, 3, 1, 6, 0, 0)
    data = path.read_bytes()
    path.write_bytes(data[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + data[2:])
    turned = cv2.imread(str(path))
    assert turned is not None
    assert turned.shape[:2] == picture.shape[1::-1], "the tag is not one that OpenCV sees"
    assert read_image(path)[0].shape == picture.shape


def test_pair_has_name_and_notes_of_both(tmp_path: Path, picture: np.ndarray) -> None:
    left = save(tmp_path / "scene_l.png", picture)
    right = save(tmp_path / "scene_r.png", picture[:, ::-1, 0])
    pair = read_pair(left, right)
    assert (pair.name, pair.width, pair.height) == ("scene_l", 17, 13)
    assert pair.notes == ("scene_r.png is gray: its values are used for all three channels",)
    np.testing.assert_array_equal(pair.left, picture)
    assert read_pair(left, right, "desk").name == "desk"


def test_the_same_picture_twice_is_noted(tmp_path: Path, picture: np.ndarray) -> None:
    path = save(tmp_path / "left.png", picture)
    assert "same picture" in read_pair(path, path).notes[0]


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_image(path)
    assert "\n" not in str(caught.value)
    assert str(path) in caught.value.problem
    assert caught.value.remedy
    return caught.value.problem


def test_missing_file(tmp_path: Path) -> None:
    assert "does not exist" in refused(tmp_path / "none.png")


def test_folder(tmp_path: Path) -> None:
    assert "is a folder" in refused(tmp_path)


def test_file_as_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    assert "cannot be read" in refused(tmp_path / "file" / "left.png")


def test_no_right_to_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(self: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", deny)
    assert "Permission denied" in refused(tmp_path / "left.png")


@pytest.mark.parametrize(
    "content", [b"hello, world\n" * 9, b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff\xe0", b"P6\n3 3\n"]
)
def test_not_an_image(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "left.png"
    path.write_bytes(content)
    assert "cannot be decoded" in (problem := refused(path)) or "cut short" in problem


def test_empty_file(tmp_path: Path) -> None:
    (tmp_path / "left.png").touch()
    assert "is empty" in refused(tmp_path / "left.png")


@pytest.mark.parametrize("suffix", [".png", ".ppm", ".jpg", ".tiff"])
@pytest.mark.parametrize("keep", [lambda n: n // 4, lambda n: n // 2, lambda n: n - 13, lambda n: n - 1])
def test_cut_file(
    tmp_path: Path,
    rng: np.random.Generator,
    capfd: pytest.CaptureFixture[str],
    suffix: str,
    keep: Callable[[int], int],
) -> None:
    path = save(tmp_path / f"left{suffix}", rng.integers(0, 256, (60, 80, 3), dtype=np.uint8))
    data = path.read_bytes()
    path.write_bytes(data[: keep(len(data))])
    refused(path)
    assert capfd.readouterr() == ("", ""), "the decoder's own messages reach the user"


def test_damaged_png(tmp_path: Path, picture: np.ndarray) -> None:
    path = save(tmp_path / "left.png", picture)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)
    assert "cannot be decoded" in refused(path)


def test_huge_png_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A few bytes can announce gigapixels, so the header is looked at before anything is decoded."""
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("decoded"))

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    path = tmp_path / "left.png"
    header = struct.pack(">IIBBBBB", 60000, 50000, 8, 2, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", b"") + chunk(b"IEND", b"")
    )
    assert "60000x50000" in refused(path)


def test_too_wide(tmp_path: Path) -> None:
    assert f"{MAX_SIDE + 1}x2" in refused(
        save(tmp_path / "left.ppm", np.zeros((2, MAX_SIDE + 1, 3), np.uint8))
    )


def test_float_image(tmp_path: Path, picture: np.ndarray) -> None:
    assert "float32" in refused(save(tmp_path / "left.tiff", picture.astype(np.float32)))


def test_sizes_that_differ_are_both_named(tmp_path: Path, picture: np.ndarray) -> None:
    left, right = save(tmp_path / "left.png", picture), save(tmp_path / "right.png", picture[:-2])
    with pytest.raises(InputError, match=r"left\.png' is 17x13, but .*right\.png' is 17x11"):
        read_pair(left, right)


@pytest.mark.parametrize(
    "bad", [np.zeros((4, 5), np.uint16), np.zeros((4, 5, 3)), np.zeros((4, 5, 4), np.uint8)]
)
def test_pair_of_other_arrays(bad: np.ndarray) -> None:
    with pytest.raises(InputError, match="the right image is"):
        StereoPair(np.zeros((4, 5, 3), np.uint8), bad, "x")


def test_pair_of_arrays_of_other_sizes() -> None:
    with pytest.raises(InputError, match="the left image is 5x4, but the right image is 6x4"):
        StereoPair(np.zeros((4, 5, 3), np.uint8), np.zeros((4, 6, 3), np.uint8), "x")
