"""How many bits a camera's files hold, and a pair's way into the pixels of a core."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden.data.images import read_joined, read_pair
from softdepth.golden.data.pair import StereoPair, rescale
from softdepth.spec.errors import InputError
from tests.golden.conftest import save
from tests.support.images import read_image


def write_netpbm(path: Path, values: np.ndarray, white: int, header: str = "{}\n{} {}\n{}\n") -> Path:
    """A binary PGM (H x W) or PPM (H x W x 3)."""
    height, width = values.shape[:2]
    kind = "P5" if values.ndim == 2 else "P6"
    data = values.astype(">u2" if white > 255 else np.uint8).tobytes()
    path.write_bytes(header.format(kind, width, height, white).encode() + data)
    return path


@pytest.fixture
def values(rng: np.random.Generator) -> np.ndarray:
    """Gray in 0 .. 1, with both ends."""
    values = rng.random((6, 9))
    values[0, :2] = 0, 1
    return values


@pytest.mark.parametrize(
    ("white", "bits"), [(15, 8), (100, 8), (255, 8), (1000, 10), (1023, 10), (4095, 12), (16383, 14)]
)
@pytest.mark.parametrize("colours", [False, True])
def test_netpbm_has_the_depth_of_its_largest_value(
    tmp_path: Path, values: np.ndarray, white: int, bits: int, colours: bool
) -> None:
    samples = np.rint(values * white).astype(int)
    samples = np.dstack([samples, samples // 2, white - samples]) if colours else samples
    image, notes, found = read_image(write_netpbm(tmp_path / "left.ppm", samples, white))
    assert found == bits
    scale = 2**bits - 1
    np.testing.assert_array_equal(image, np.floor(samples * scale / white + 0.5))
    assert bool(notes) == (white != scale), "only a change of values is worth a note"
    eight = StereoPair(image, image, "x", bits=bits).as_format("gray8" if not colours else "rgb8")
    np.testing.assert_allclose(eight.left, samples * (255 / white), atol=1)


@pytest.mark.parametrize(
    "header", ["{} {} {} {} ", "{}\n# 7 8 9\n{} {}\n# by a camera\n{}\n", "{}\r\n{} {}\r\n{}\r\n"]
)
@pytest.mark.parametrize("white", [15, 1023])
def test_netpbm_headers(tmp_path: Path, values: np.ndarray, white: int, header: str) -> None:
    samples = np.rint(values * white).astype(int)
    plain = read_image(write_netpbm(tmp_path / "plain.pgm", samples, white))
    image = read_image(write_netpbm(tmp_path / "left.pgm", samples, white, header))
    np.testing.assert_array_equal(image.pixels, plain.pixels)
    assert image.bits == plain.bits


def test_netpbm_in_text(tmp_path: Path) -> None:
    (path := tmp_path / "left.pgm").write_text("P2\n# text\n3 1\n1023\n0 511 1023\n")
    image, _, bits = read_image(path)
    assert bits == 10
    np.testing.assert_array_equal(image, [[0, 511, 1023]])


def test_bitmaps_are_black_where_they_are_set(tmp_path: Path) -> None:
    (path := tmp_path / "left.pbm").write_bytes(b"P4\n2 1\n\x80")
    np.testing.assert_array_equal(read_image(path).pixels, [[0, 255]])


def test_netpbm_beyond_its_largest_value(tmp_path: Path) -> None:
    path = write_netpbm(tmp_path / "left.pgm", np.array([[3, 200]]), 100)
    with pytest.raises(InputError, match="holds 200, but its header says 100"):
        read_image(path)


@pytest.mark.parametrize("suffix", [".png", ".tiff", ".pgm"])
@pytest.mark.parametrize("bits", [10, 12, 14])
def test_sixteen_bit_files_are_read_at_the_depth_of_their_values(
    tmp_path: Path, values: np.ndarray, suffix: str, bits: int
) -> None:
    """Both views are looked at: here the left one is dark, and gets the right one's scale all the same."""
    right = np.rint(values * (2**bits - 1)).astype(np.uint16)
    left = right // 8
    pair = read_pair(save(tmp_path / f"a{suffix}", left), save(tmp_path / f"b{suffix}", right))
    assert (pair.bits, pair.channels) == (bits, 1)
    np.testing.assert_array_equal(pair.left, left)
    np.testing.assert_array_equal(pair.right, right)
    assert f"so read as {bits} bits" in pair.notes[0]
    assert f"a{suffix} and b{suffix}" in pair.notes[0]
    assert "--bits" in pair.notes[0]


def test_sixteen_bits_that_are_used_are_kept(tmp_path: Path, picture: np.ndarray) -> None:
    image, notes, bits = read_image(save(tmp_path / "left.png", picture.astype(np.uint16) * 257))
    assert (notes, bits) == ((), 16)
    pair = StereoPair(image, image[:, ::-1], "x", bits=16).as_format("rgb8")
    np.testing.assert_array_equal(pair.left, picture)
    assert pair.notes == ("the pair has 16 bits a channel: reduced to the 8 of the core",)


def test_bits_decide(tmp_path: Path, values: np.ndarray) -> None:
    dark = np.rint(values * 900).astype(np.uint16)
    left, right = save(tmp_path / "a.png", dark), save(tmp_path / "b.png", dark[:, ::-1])
    assert read_pair(left, right).bits == 10
    pair = read_pair(left, right, bits=12)
    assert pair.bits == 12
    np.testing.assert_array_equal(pair.left, dark)
    with pytest.raises(InputError, match="holds 900, more than --bits 9 allows; use --bits 10"):
        read_pair(left, right, bits=9)
    with pytest.raises(InputError, match="--bits 17"):
        read_pair(left, right, bits=17)


def test_bits_of_an_eight_bit_file(tmp_path: Path) -> None:
    path = save(tmp_path / "a.png", np.array([[0, 1, 15]], np.uint8))
    np.testing.assert_array_equal(read_image(path, bits=4).pixels, [[0, 17, 255]])


def test_views_of_two_depths_get_one_scale(tmp_path: Path, values: np.ndarray) -> None:
    left = write_netpbm(tmp_path / "a.pgm", np.rint(values * 255).astype(int), 255)
    right = write_netpbm(tmp_path / "b.pgm", np.rint(values * 4095).astype(int), 4095)
    pair = read_pair(left, right)
    assert pair.bits == 12
    np.testing.assert_allclose(pair.left.astype(int), pair.right, atol=9)
    assert pair.left.max() == pair.right.max() == 4095
    assert pair.notes == ("a.pgm has values 0 to 255: they are scaled to 12 bits",)


def test_tiff_tells_its_white(tmp_path: Path) -> None:
    """MaxSampleValue, where it is one less than a power of two."""
    from PIL import Image

    samples = np.array([[0, 500, 900]], np.uint16)
    for white, bits in ((4095, 12), (900, 10)):
        Image.fromarray(samples).save(path := tmp_path / "a.tiff", tiffinfo={281: white})
        image, _, found = read_image(path)
        assert found == bits
        np.testing.assert_array_equal(image, samples)


@pytest.mark.parametrize("bits", [10, 12])
def test_tiff_with_packed_samples(tmp_path: Path, bits: int) -> None:
    import struct

    samples = [0, 1, 2 ** (bits - 1), 2**bits - 1]
    packed = int("".join(f"{s:0{bits}b}" for s in samples), 2).to_bytes(bits // 2, "big")
    tags = ((256, 4, 4), (257, 4, 1), (258, 3, bits), (259, 3, 1), (262, 3, 1), (273, 4, 8))
    tags += ((277, 3, 1), (278, 4, 1), (279, 4, len(packed)))
    entries = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    data = b"II*\0" + struct.pack("<I", 8 + len(packed) + len(packed) % 2) + packed + bytes(len(packed) % 2)
    (path := tmp_path / "a.tiff").write_bytes(data + struct.pack("<H", len(tags)) + entries + bytes(4))
    image, _, found = read_image(path)
    assert found == bits
    np.testing.assert_array_equal(image, [samples])


@pytest.mark.parametrize(("low", "high", "said"), [(0, 60, True), (100, 163, True), (0, 64, False)])
def test_less_than_a_quarter_of_the_range_is_noted(tmp_path: Path, low: int, high: int, said: bool) -> None:
    image = np.full((3, 4), low, np.uint8)
    image[1, 2] = high
    left, right = save(tmp_path / "a.png", image), save(tmp_path / "b.png", image[:, ::-1])
    text = f"the pair uses the values {low} to {high} of 0 to 255, less than a quarter of the range"
    assert any(text in note for note in read_pair(left, right).notes) == said


def test_gray_beside_colours(tmp_path: Path, picture: np.ndarray) -> None:
    left, right = save(tmp_path / "a.png", picture), save(tmp_path / "b.png", picture[:, :, 1])
    pair = read_pair(left, right)
    assert pair.channels == 3
    assert pair.notes == ("b.png is gray: its values are used for all three channels",)


@pytest.mark.parametrize("bits", [8, 10, 12])
def test_gray_on_a_gray_core_is_untouched(rng: np.random.Generator, bits: int) -> None:
    left = rng.integers(0, 2**bits, (5, 7)).astype(np.uint8 if bits == 8 else np.uint16)
    pair = StereoPair(left, left[:, ::-1], "x", bits=bits)
    assert pair.as_format(f"gray{bits}") is pair
    tripled = pair.as_format(f"rgb{bits}")
    np.testing.assert_array_equal(tripled.left, np.dstack([left] * 3))
    assert len(tripled.notes) == 1
    assert "all three channels" in tripled.notes[0]


def test_colours_on_a_gray_core(picture: np.ndarray) -> None:
    pair = StereoPair(picture, picture[:, ::-1], "x").as_format("gray8")
    red, green, blue = (picture[:, :, c].astype(int) for c in range(3))
    np.testing.assert_array_equal(pair.left, (red + 2 * green + blue) // 4)
    assert "gray pixels" in pair.notes[0]


def test_more_bits_than_the_pair_has() -> None:
    image = np.array([[0, 128, 255]], np.uint8)
    pair = StereoPair(image, image, "x").as_format("gray12")
    np.testing.assert_array_equal(pair.left, [[0, 2056, 4095]])
    assert (pair.bits, pair.left.dtype) == (12, np.uint16)
    assert "widened to the 12" in pair.notes[0]


@pytest.mark.parametrize("name", ["yuv8", "gray", "rgb99", "rgb0"])
def test_no_pixel_format(name: str) -> None:
    image = np.zeros((2, 2), np.uint8)
    with pytest.raises(InputError, match=f"'{name}' is not a pixel format"):
        StereoPair(image, image, "x").as_format(name)


def test_rescaling_rounds_to_the_nearest_for_every_value() -> None:
    for maximum, bits in ((65535, 8), (1023, 8), (4095, 10), (255, 12), (100, 8), (65535, 16)):
        every = np.arange(maximum + 1).astype(np.uint16)[np.newaxis]
        exact = every.astype(np.float64) * (2**bits - 1) / maximum
        assert np.abs(rescale(every, maximum, bits) - exact).max() <= 0.5


@pytest.mark.parametrize(
    ("left", "bits", "problem"),
    [
        (np.zeros((2, 3), np.uint8), 10, "give uint16 for 10 bits"),
        (np.full((2, 3), 1024, np.uint16), 10, "holds 1024, but 10 bits end at 1023"),
        (np.zeros((2, 3, 3), np.uint16), 10, "one image is gray and the other is RGB"),
        (np.zeros((2, 3), np.uint16), 17, "17 bits"),
    ],
)
def test_pairs_that_cannot_be(left: np.ndarray, bits: int, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        StereoPair(left, np.zeros((2, 3), np.uint16), "x", bits=bits)


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_a_pair_in_one_file(tmp_path: Path, rng: np.random.Generator, depth: type) -> None:
    left, right = rng.integers(0, np.iinfo(depth).max, (2, 4, 6)).astype(depth)
    left[0, 0] = np.iinfo(depth).max
    beside = read_joined(save(tmp_path / "both.png", np.hstack([left, right])), "side-by-side")
    above = read_joined(save(tmp_path / "both.png", np.vstack([left, right])), "top-bottom")
    for pair in (beside, above):
        assert pair.name == "both"
        np.testing.assert_array_equal(pair.left, left)
        np.testing.assert_array_equal(pair.right, right)


def test_a_pair_in_one_file_that_does_not_halve(tmp_path: Path) -> None:
    path = save(tmp_path / "both.png", np.zeros((4, 7), np.uint8))
    with pytest.raises(InputError, match="is 7x4: 7 columns cannot be halved"):
        read_joined(path, "side-by-side")
    assert read_joined(path, "top-bottom").height == 2


def test_opencv_writes_what_we_read(tmp_path: Path, rng: np.random.Generator) -> None:
    """16-bit RGB comes in exactly from PNG and TIFF: many readers reduce it to 8 bits in silence."""
    image = rng.integers(0, 65536, (5, 6, 3)).astype(np.uint16)
    for suffix in (".png", ".tiff"):
        path = tmp_path / f"a{suffix}"
        assert cv2.imwrite(str(path), image[:, :, ::-1])
        np.testing.assert_array_equal(read_image(path).pixels, image)
