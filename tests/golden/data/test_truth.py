"""Ground truth: every coding by value, occlusions by hand and against plain loops."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden.data.truth import Truth, View, cross_check, from_disparity, read_truth, visible, warp
from softdepth.golden.data.writers import write_disparity_png, write_pfm
from softdepth.spec.errors import InputError
from tests.golden.conftest import save

NAN = np.nan


def check(truth: Truth, disparity: np.ndarray, gray: np.ndarray) -> None:
    np.testing.assert_array_equal(truth.disparity, disparity)
    np.testing.assert_array_equal(truth.gray, gray)
    assert truth.disparity.dtype == truth.gray.dtype == np.float32
    np.testing.assert_array_equal(truth.known, np.isfinite(disparity))


@pytest.mark.parametrize(("scale", "divisor"), [(None, 4), (8, 8), (2.5, 2.5)])
def test_eight_bit_gray(tmp_path: Path, scale: float | None, divisor: float) -> None:
    gray = np.array([[0, 4, 10], [255, 1, 0]], np.uint8)
    path = save(tmp_path / "disp2.png", gray)
    expected = np.where(gray > 0, gray / np.float32(divisor), NAN).astype(np.float32)
    check(read_truth(path, scale=scale), expected, gray)


def test_gray_in_three_equal_channels(tmp_path: Path) -> None:
    gray = np.array([[0, 4, 10]], np.uint8)
    path = save(tmp_path / "disp2.png", np.dstack([gray] * 3))
    np.testing.assert_array_equal(read_truth(path).gray, gray)


def test_kitti(tmp_path: Path) -> None:
    path = save(tmp_path / "000000_10.png", np.array([[0, 256, 384, 65535]], np.uint16))
    disparity = np.array([[NAN, 1, 1.5, 65535 / 256]], np.float32)
    check(read_truth(path), disparity, np.nan_to_num(4 * disparity))


def test_pfm_takes_every_finite_value(tmp_path: Path) -> None:
    """0 and negative disparities are as good as others: converging cameras have them."""
    values = np.array([[np.inf, 1.25], [NAN, -3], [0, 70]], np.float32)
    path = tmp_path / "disp0.pfm"
    path.write_bytes(b"Pf\n2 3\n-1\n" + values[::-1].tobytes())
    disparity = np.array([[NAN, 1.25], [NAN, -3], [0, 70]], np.float32)
    check(read_truth(path), disparity, np.array([[0, 5], [0, -12], [0, 280]]))


def test_pfm_agrees_with_opencv(tmp_path: Path, rng: np.random.Generator) -> None:
    values = rng.uniform(1, 60, (7, 5)).astype(np.float32)
    cv2.imwrite(str(path := tmp_path / "disp0.pfm"), values)
    np.testing.assert_array_equal(read_truth(path).disparity, values)


@pytest.mark.parametrize("header", [b"Pf\n2 1\n%s0.003922\n", b"Pf 2 1 %s1\n", b"Pf\n2\n1\n%s1e0\n"])
@pytest.mark.parametrize(("sign", "order"), [(b"-", "<f4"), (b"", ">f4")])
def test_pfm_headers(tmp_path: Path, header: bytes, sign: bytes, order: str) -> None:
    """Both byte orders, any white space; the size of the scale is not applied."""
    path = tmp_path / "disp0.pfm"
    path.write_bytes(header % sign + np.array([10, 32], order).tobytes())
    np.testing.assert_array_equal(read_truth(path).disparity, [[10, 32]])


def test_pfm_rows_run_from_the_bottom(tmp_path: Path) -> None:
    path = tmp_path / "disp0.pfm"
    path.write_bytes(b"Pf\n1 2\n-1\n" + np.array([1, 2], "<f4").tobytes())
    np.testing.assert_array_equal(read_truth(path).disparity, [[2], [1]])


def refused(path: Path, **options: object) -> str:
    with pytest.raises(InputError) as caught:
        read_truth(path, **options)  # pyright: ignore[reportArgumentType]
    assert "\n" not in str(caught.value)
    assert caught.value.remedy
    return caught.value.problem


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"Pf\n2 x\n-1\n", "broken PFM header"),
        (b"Pf\n0 4\n-1\n", "broken PFM header"),
        (b"Pf\n2 2", "broken PFM header"),
        (b"PF\n1 1\n-1\n" + bytes(12), "three-channel PFM"),
        (b"Pf\n2 2\n-1\n" + bytes(15), "cut short"),
        (b"nothing", "cannot be decoded"),
    ],
)
def test_broken_files(tmp_path: Path, content: bytes, problem: str) -> None:
    path = tmp_path / "disp0.pfm"
    path.write_bytes(content)
    assert problem in refused(path)


def test_missing_file(tmp_path: Path) -> None:
    assert "does not exist" in refused(tmp_path / "disp2.png")


def test_size_other_than_the_images(tmp_path: Path) -> None:
    path = save(tmp_path / "disp2.png", np.full((3, 5), 9, np.uint8))
    assert read_truth(path, shape=(3, 5)).disparity.shape == (3, 5)
    problem = refused(path, shape=(5, 3))
    assert "5x3" in problem
    assert "3x5" in problem


def test_other_kind_than_asked_for(tmp_path: Path) -> None:
    path = save(tmp_path / "disp2.png", np.full((3, 5), 9, np.uint8))
    assert "is gray8, not kitti16" in refused(path, kind="kitti16")
    assert read_truth(path, kind="gray8").known.all()


@pytest.mark.parametrize("scale", [0, -4, np.inf, NAN])
def test_scale_must_be_positive(tmp_path: Path, scale: float) -> None:
    assert "not a positive number" in refused(
        save(tmp_path / "d.png", np.ones((2, 2), np.uint8)), scale=scale
    )


def test_colour_picture_is_no_truth(tmp_path: Path, picture: np.ndarray) -> None:
    assert "colour picture" in refused(save(tmp_path / "d.png", picture))


def test_truth_without_a_known_pixel(tmp_path: Path) -> None:
    assert "no known disparity" in refused(save(tmp_path / "d.png", np.zeros((2, 2), np.uint8)))


# Left view: a far wall (1), and from column 4 a near object (3), which hides columns 2 and 3 of the wall
# in the right view; column 0 leaves the image.
LEFT = np.array([[1, 1, 1, 1, 3, 3, 3]], np.float32)
RIGHT = np.array([[1, 3, 3, 3, NAN, NAN, NAN]], np.float32)
SEEN = np.array([[False, True, False, False, True, True, True]])


def test_warp_keeps_the_nearest() -> None:
    np.testing.assert_array_equal(warp(LEFT), RIGHT)
    np.testing.assert_array_equal(warp(RIGHT, "right"), [[NAN, 1, NAN, NAN, 3, 3, 3]])


def test_visible_by_hand() -> None:
    np.testing.assert_array_equal(visible(LEFT), SEEN)
    np.testing.assert_array_equal(visible(RIGHT, "right"), np.isfinite(RIGHT))


def test_cross_check_by_hand() -> None:
    np.testing.assert_array_equal(cross_check(LEFT, RIGHT), SEEN)
    np.testing.assert_array_equal(cross_check(RIGHT, LEFT, "right"), np.isfinite(RIGHT))
    np.testing.assert_array_equal(cross_check(LEFT, RIGHT + 1), SEEN)
    assert not cross_check(LEFT, RIGHT + 1.25).any()


@pytest.mark.parametrize("view", ["left", "right"])
def test_occlusions_against_plain_loops(rng: np.random.Generator, view: View) -> None:
    disparity = (rng.integers(0, 60, (6, 30)) / 4).astype(np.float32)
    other = (rng.integers(0, 60, (6, 30)) / 4).astype(np.float32)
    disparity[rng.random(disparity.shape) < 0.1] = NAN
    other[rng.random(other.shape) < 0.1] = NAN
    height, width = disparity.shape
    sign = -1 if view == "left" else 1
    seen, confirmed = np.zeros((2, height, width), bool)
    for y in range(height):
        landing = {x: round(x + sign * float(disparity[y, x])) for x in range(width) if disparity[y, x] >= 0}
        for x, column in landing.items():
            if 0 <= column < width:
                rivals = [disparity[y, i] for i, c in landing.items() if c == column]
                seen[y, x] = disparity[y, x] >= max(rivals) - 1
                confirmed[y, x] = abs(disparity[y, x] - other[y, column]) <= 1
    assert 0 < seen.sum() < seen.size
    assert confirmed.any()
    np.testing.assert_array_equal(visible(disparity, view), seen)
    np.testing.assert_array_equal(cross_check(disparity, other, view), confirmed)


def test_evidence_is_named() -> None:
    assert from_disparity(LEFT).evidence == "warp"
    both = from_disparity(LEFT, other=RIGHT)
    assert both.evidence == "cross-check"
    np.testing.assert_array_equal(both.nonoccluded, SEEN)


def test_read_truth_finds_occlusions_of_its_view(tmp_path: Path) -> None:
    write_disparity_png(path := tmp_path / "d.png", RIGHT)
    np.testing.assert_array_equal(read_truth(path, view="right").nonoccluded, np.isfinite(RIGHT))
    assert read_truth(path, view="left").nonoccluded.sum() < 4  # pyright: ignore[reportOptionalMemberAccess]


def test_views_of_other_sizes() -> None:
    with pytest.raises(InputError, match="7x1 and 6x1"):
        cross_check(LEFT, RIGHT[:, 1:])


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.float16, np.int16, np.uint8])
def test_npy(tmp_path: Path, dtype: type) -> None:
    """Of any type of number; 0 and negative values are disparities, NaN and infinite ones unknown."""
    values = np.array([[0, 3, 12], [7, 1, 60]], dtype)
    expected = values.astype(np.float32)
    if np.issubdtype(dtype, np.floating):
        values[0, 1], values[1, 1] = NAN, np.inf
        values[1, 2], expected[1, 2] = -2, -2
        expected[0, 1] = expected[1, 1] = NAN
    np.save(path := tmp_path / "d.npy", values)
    np.testing.assert_array_equal(read_truth(path).disparity, expected)
    np.testing.assert_array_equal(read_truth(path, kind="npy", scale=2).disparity, expected / 2)


def test_npy_with_an_axis_too_many(tmp_path: Path) -> None:
    values = np.arange(6, dtype=np.float32).reshape(1, 2, 3, 1)
    np.save(path := tmp_path / "d.npy", values)
    np.testing.assert_array_equal(read_truth(path).disparity, values[0, :, :, 0])


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        (np.zeros((2, 3, 3)), "has the shape"),
        (np.zeros(7), "has the shape"),
        (np.zeros((0, 3)), "has the shape"),
        (np.zeros((2, 2), complex), "complex128"),
        (np.zeros((2, 2), bool), "bool"),
    ],
)
def test_npy_that_is_no_map(tmp_path: Path, values: np.ndarray, problem: str) -> None:
    np.save(path := tmp_path / "d.npy", values)
    assert problem in refused(path)


def test_npy_with_objects_is_not_run(tmp_path: Path) -> None:
    np.save(path := tmp_path / "d.npy", np.array([[print]], object), allow_pickle=True)
    assert "not a readable NPY" in refused(path)
    path.write_bytes(path.read_bytes()[:40])
    assert "not a readable NPY" in refused(path)


def test_float_tiff(tmp_path: Path) -> None:
    values = np.array([[0, 2.5, NAN], [-4, np.inf, 60]], np.float32)
    path = save(tmp_path / "d.tiff", values)
    np.testing.assert_array_equal(read_truth(path).disparity, np.where(np.isfinite(values), values, NAN))
    assert read_truth(path, kind="float").notes


def test_zeros_in_floats_are_noted(tmp_path: Path) -> None:
    values = np.full((10, 10), 5, np.float32)
    values[:3] = 0
    write_pfm(path := tmp_path / "d.pfm", values)
    assert "30.0 % of the truth is 0" in read_truth(path).notes[0]
    values[:3] = 1
    write_pfm(path, values)
    assert read_truth(path).notes == ()


@pytest.mark.parametrize(
    ("levels", "dtype", "asked"),
    [
        ([0, 5, 9, 31], np.uint8, True),  # a level a pixel
        ([0, 5, 9, 32], np.uint8, False),
        ([0, 4, 8, 20], np.uint8, False),  # whole pixels at 4 levels each
        ([0, 5, 9, 31], np.uint16, True),
        ([0, 5, 9, 255], np.uint16, True),  # all below a pixel
        ([0, 256, 300, 511], np.uint16, False),
    ],
)
def test_levels_that_cannot_be_right_are_asked_about(
    tmp_path: Path, levels: list[int], dtype: type, asked: bool
) -> None:
    path = save(tmp_path / "d.png", np.array([levels], dtype))
    if asked:
        with pytest.raises(InputError, match=f"levels up to {max(levels)}.*--gt-scale"):
            read_truth(path, candidates=32)
    else:
        read_truth(path, candidates=32)
    read_truth(path, candidates=32, scale=2)  # who says the scale is not asked
    read_truth(path)
