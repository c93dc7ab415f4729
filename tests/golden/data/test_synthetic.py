"""Synthetic scenes: their truth is exact, by definition and not by trust."""

import numpy as np
import pytest

from softdepth.golden.data.synthetic import SCENES, generate
from softdepth.golden.data.truth import View
from softdepth.spec.errors import InputError

every_scene = pytest.mark.parametrize("scene", SCENES)


@every_scene
@pytest.mark.parametrize("view", ["left", "right"])
def test_truth_is_exact(scene: str, view: View) -> None:
    """Both views show the same colour wherever the truth says they see the same point."""
    pair = generate(scene, width=120, height=60, disparities=24, seed=3, view=view)
    truth = pair.truth
    assert truth is not None
    assert truth.nonoccluded is not None
    assert not (truth.nonoccluded & ~truth.known).any()
    y, x = np.nonzero(truth.nonoccluded)
    d = truth.disparity[y, x].astype(int)
    here, there, sign = (pair.left, pair.right, -1) if view == "left" else (pair.right, pair.left, 1)
    np.testing.assert_array_equal(here[y, x], there[y, x + sign * d])
    assert truth.nonoccluded.mean() > 0.8
    known = truth.disparity[truth.known]
    assert (known == np.rint(known)).all()
    assert known.min() >= 1
    assert known.max() <= 23
    np.testing.assert_array_equal(truth.gray, np.nan_to_num(4 * truth.disparity))


@every_scene
def test_occlusions_against_a_plain_search(scene: str) -> None:
    """A left pixel is occluded if and only if a nearer one moves onto its column, or it leaves."""
    truth = generate(scene, width=90, height=12, disparities=16, seed=1).truth
    assert truth is not None
    assert truth.known.all()
    for row, seen in zip(truth.disparity.astype(int), truth.nonoccluded, strict=True):  # pyright: ignore
        columns = np.arange(90) - row
        for x in range(90):
            rivals = row[columns == columns[x]]
            assert seen[x] == (columns[x] >= 0 and row[x] == rivals.max())


@every_scene
def test_both_views_are_one_scene(scene: str) -> None:
    left = generate(scene, width=80, height=40, disparities=16, seed=5)
    right = generate(scene, width=80, height=40, disparities=16, seed=5, view="right")
    np.testing.assert_array_equal(left.left, right.left)
    np.testing.assert_array_equal(left.right, right.right)
    assert left.truth is not None
    assert right.truth is not None
    assert left.truth.nonoccluded.sum() == right.truth.nonoccluded.sum()  # pyright: ignore


@every_scene
def test_only_the_true_disparity_matches(scene: str) -> None:
    """Texture everywhere: no other candidate reproduces the colour over a 5x5 window."""
    pair = generate(scene, width=100, height=50, disparities=16, seed=2)
    rng = np.random.default_rng(0)
    truth = pair.truth
    assert truth is not None
    assert truth.nonoccluded is not None
    flat = np.lib.stride_tricks.sliding_window_view(np.nan_to_num(truth.disparity), (5, 5))
    seen = np.lib.stride_tricks.sliding_window_view(truth.nonoccluded, (5, 5)).all((2, 3))
    candidates = np.argwhere(seen & (flat.max((2, 3)) == flat.min((2, 3))))
    candidates = candidates[candidates[:, 1] >= 16]
    for y, x in candidates[rng.choice(len(candidates), 40)]:
        window = pair.left[y : y + 5, x : x + 5].astype(int)
        sad = [np.abs(window - pair.right[y : y + 5, x - d : x - d + 5]).sum() for d in range(16)]
        assert sad[int(truth.disparity[y, x])] == 0
        assert sorted(sad)[1] > 100


def test_seed_decides_everything() -> None:
    first, again, other = (generate("random", width=64, height=48, disparities=8, seed=s) for s in (7, 7, 8))
    np.testing.assert_array_equal(first.left, again.left)
    np.testing.assert_array_equal(first.right, again.right)
    assert (first.left != other.left).any()
    assert (first.truth.disparity != other.truth.disparity).any()  # pyright: ignore
    assert first.name == "synthetic:random@64x48x8#7"


@every_scene
@pytest.mark.parametrize(("width", "height", "disparities"), [(8, 1, 4), (9, 2, 8), (256, 3, 256)])
def test_smallest_and_deepest(scene: str, width: int, height: int, disparities: int) -> None:
    pair = generate(scene, width=width, height=height, disparities=disparities)
    assert pair.left.shape == pair.right.shape == (height, width, 3)
    assert 1 <= pair.truth.disparity.min() <= pair.truth.disparity.max() < disparities  # pyright: ignore


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"width": 7}, "width is 7"),
        ({"height": 0}, "height is 0"),
        ({"width": 9000}, "width is 9000"),
        ({"disparities": 3}, "disparities is 3"),
        ({"disparities": 40, "width": 32}, "disparities is 40"),
        ({"seed": -1}, "seed is -1"),
    ],
)
def test_out_of_bounds(options: dict[str, int], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        generate("plane", **options)  # pyright: ignore[reportArgumentType]


def test_unknown_scene() -> None:
    with pytest.raises(InputError, match="unknown synthetic scene 'moon'; use one of plane, steps"):
        generate("moon")
