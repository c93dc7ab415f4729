"""Files of many pages and of other colours, and libraries that would talk to the user."""

import io
import os
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from softdepth.golden.data.decode import quiet
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.truth import read_truth
from softdepth.spec.errors import InputError
from tests.support.images import read_image


@pytest.mark.parametrize(
    ("suffix", "what", "options"),
    [
        (".tiff", "pages", {}),
        (".png", "frames", {}),
        (".webp", "frames", {"lossless": True}),
        (".gif", "frames", {}),
    ],
)
def test_the_first_of_several_pages_is_used(
    tmp_path: Path, picture: np.ndarray, suffix: str, what: str, options: dict[str, object]
) -> None:
    first = picture // 64 * 64
    others = [Image.fromarray(picture), Image.fromarray(255 - picture)]
    path = tmp_path / f"left{suffix}"
    Image.fromarray(first).save(path, save_all=True, append_images=others, **options)
    image, notes, _ = read_image(path)
    np.testing.assert_allclose(image, first, atol=0 if suffix != ".gif" else 40)
    assert f"left{suffix} holds 3 {what}: the first is used" in notes


def test_the_first_of_several_pictures_in_a_pgm(tmp_path: Path) -> None:
    (path := tmp_path / "a.pgm").write_bytes(2 * b"P5\n2 1\n255\n\x05\x07")
    image, notes, _ = read_image(path)
    np.testing.assert_array_equal(image, [[5, 7]])
    assert notes == ("a.pgm goes on after its first picture: only that is used",)


@pytest.mark.parametrize("suffix", [".tiff", ".jpg"])
def test_cmyk_is_converted_and_called_so(tmp_path: Path, suffix: str) -> None:
    colours = np.zeros((16, 24, 3), np.uint8)
    colours[:, :12] = 200, 30, 60
    colours[:, 12:] = 20, 120, 240
    Image.fromarray(colours).convert("CMYK").save(path := tmp_path / f"left{suffix}")
    image, notes, _ = read_image(path)
    assert notes == (f"left{suffix} is CMYK: it is converted to RGB",)
    assert image.shape == colours.shape
    inside = np.abs(image.astype(int) - colours)[:, [2, 20]]
    assert inside.max() < 12, "CMYK read as RGB with alpha"


def test_gray_with_alpha_stays_gray(tmp_path: Path, picture: np.ndarray) -> None:
    Image.fromarray(picture).convert("LA").save(path := tmp_path / "left.png")
    image, notes, _ = read_image(path)
    assert image.ndim == 2
    assert notes == ("left.png has an alpha channel: it is dropped",)


def chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def warned_png(image: np.ndarray) -> bytes:
    """A sound picture with a time stamp that libpng complains about."""
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG")
    data = file.getvalue()
    end = data.index(b"IHDR") + 4 + 13 + 4
    return data[:end] + chunk(b"tIME", bytes(2)) + data[end:]


def test_what_libpng_says_stays_inside(
    tmp_path: Path, picture: np.ndarray, capfd: pytest.CaptureFixture[str]
) -> None:
    import cv2

    data = warned_png(picture)
    cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    assert "libpng warning" in capfd.readouterr().err, "the file is not one that libpng complains about"
    (path := tmp_path / "left.png").write_bytes(data)
    np.testing.assert_array_equal(read_image(path).pixels, picture)
    assert capfd.readouterr() == ("", "")


def test_a_damaged_jpeg_is_noted_in_one_line(
    tmp_path: Path, rng: np.random.Generator, capfd: pytest.CaptureFixture[str]
) -> None:
    """The decoder goes on after damage, so a user has to be told."""
    file = io.BytesIO()
    Image.fromarray(rng.integers(0, 256, (64, 64, 3), dtype=np.uint8)).save(file, "JPEG")
    data = bytearray(file.getvalue())
    data[900:902] = b"\xff\xd3"
    (path := tmp_path / "left.jpg").write_bytes(bytes(data))
    (note,) = read_image(path).notes
    assert note.startswith("left.jpg may be damaged: ")
    assert capfd.readouterr() == ("", "")


def test_standard_error_is_there_again(capfd: pytest.CaptureFixture[str]) -> None:
    def fail() -> None:
        with quiet():
            os.write(2, b"from a library\n")
            raise ValueError("inside")

    with pytest.raises(ValueError, match="inside"):
        fail()
    os.write(2, b"from us\n")
    assert capfd.readouterr().err == "from us\n"


@pytest.mark.filterwarnings("error")
def test_no_warning_of_python_libraries(tmp_path: Path, picture: np.ndarray) -> None:
    """Damaged metadata makes Pillow warn, and values that overflow make NumPy warn."""
    Image.fromarray(picture).save(path := tmp_path / "a.tiff")
    data = bytearray(path.read_bytes())
    where = data.find(struct.pack("<HHI", 305, 2, 1))
    if where >= 0:
        data[where + 4 : where + 8] = struct.pack("<I", 10**6)
    path.write_bytes(bytes(data))
    read_pair(path, path)
    np.save(truth := tmp_path / "d.npy", np.array([[1e300, 4.0, np.nan, -1e300, 3.0, 5.0, 6.0]]))
    assert read_truth(truth).known.sum() == 4
    signalling = struct.pack("<4f", 1, 2, 3, 4).replace(struct.pack("<f", 2), b"\x01\x00\x80\x7f")
    (pfm := tmp_path / "d.pfm").write_bytes(b"Pf\n4 1\n-1\n" + signalling)
    assert read_truth(pfm).known.sum() == 3
    with pytest.raises(InputError):
        read_truth(truth, scale=1e-300)
