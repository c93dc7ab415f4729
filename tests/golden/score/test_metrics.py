"""Metrics: by hand, against plain loops, and the paper's RMSE with its known oddities."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from softdepth.golden.data.datasets import load
from softdepth.golden.data.truth import Truth, from_disparity
from softdepth.golden.score.metrics import coverage, evaluate, paper_rmse
from softdepth.spec.errors import InputError

KEYS = ["bad1", "bad2", "mae", "rmse"]


def truth_of(disparity: np.ndarray, nonoccluded: np.ndarray | None = None) -> Truth:
    known = np.isfinite(disparity)
    gray = np.where(known, 4 * disparity, 0).astype(np.float32)
    return Truth(disparity.astype(np.float32), gray, nonoccluded)


def test_by_hand() -> None:
    """Errors 0, 1, 1.5, 3 of four known pixels; the limits themselves are not bad."""
    truth = truth_of(np.array([[10, 11, 12.5, 13, np.nan]]), np.array([[True, True, False, False, False]]))
    metrics = evaluate(np.array([[10, 10, 11, 10, 50]], np.uint16), truth)
    assert metrics.known.bad1 == 50
    assert metrics.known.bad2 == 25
    assert metrics.known.mae == pytest.approx(5.5 / 4)
    assert metrics.known.rmse == pytest.approx(math.sqrt((1 + 2.25 + 9) / 4))
    assert metrics.nonocc is not None
    assert (metrics.nonocc.bad1, metrics.nonocc.mae) == (0, 0.5)
    assert metrics.measured == metrics.known
    assert metrics.density == 100
    # Gray: 0, 4, 6, 12, and 200 against unknown.
    assert metrics.paper_rmse == pytest.approx(math.sqrt((16 + 36 + 144 + 200**2) / 5))


def test_exactly_two_pixels_is_not_bad2() -> None:
    metrics = evaluate(np.array([[5, 5]]), truth_of(np.array([[7.0, 7.01]])))
    assert metrics.known.bad2 == 50


def test_against_plain_loops(rng: np.random.Generator) -> None:
    disparity = rng.integers(0, 70, (9, 14)).astype(np.uint16)
    values = disparity + rng.choice([-3.0, -1.5, -1, 0, 0.5, 2, 8], disparity.shape)
    values[values <= 0] = np.nan
    valid = rng.random(disparity.shape) < 0.8
    seen = (rng.random(disparity.shape) < 0.6) & np.isfinite(values)
    truth = truth_of(values, seen)
    pixels = list(np.ndindex(disparity.shape))

    def loop(chosen: list[tuple[int, ...]]) -> list[float]:
        bad1 = bad2 = total = squares = 0.0
        for p in chosen:
            error = abs((int(disparity[p]) if valid[p] else 0) - float(values[p]))
            bad1 += error > 1 or not valid[p]
            bad2 += error > 2 or not valid[p]
            total += error
            squares += error**2
        n = len(chosen)
        return [100 * bad1 / n, 100 * bad2 / n, total / n, math.sqrt(squares / n)]

    known = [p for p in pixels if not math.isnan(values[p])]
    result = evaluate(disparity, truth, valid=valid).as_dict()
    assert [result[k] for k in KEYS] == pytest.approx(loop(known))
    assert [result[f"nonocc_{k}"] for k in KEYS] == pytest.approx(loop([p for p in known if seen[p]]))
    assert [result[f"measured_{k}"] for k in KEYS] == pytest.approx(loop([p for p in known if valid[p]]))
    drawn = sum(
        ((4 * int(disparity[p]) % 256 if valid[p] else 0) - (0 if math.isnan(values[p]) else 4 * values[p]))
        ** 2
        for p in pixels
    )
    assert result["paper_rmse"] == pytest.approx(math.sqrt(drawn / len(pixels)))
    assert result["density"] == pytest.approx(100 * sum(map(bool, valid.flat)) / len(pixels))


def test_no_result_is_disparity_zero_and_bad() -> None:
    """Even where the truth is within 1 px of 0; what the core holds there does not matter."""
    truth = truth_of(np.array([[0.5, 20, 20]]))
    valid = np.array([[False, False, True]])
    metrics = evaluate(np.array([[7, 20, 20]]), truth, valid=valid)
    assert metrics.known.bad1 == pytest.approx(200 / 3)
    assert metrics.known.bad2 == pytest.approx(200 / 3)
    assert metrics.known.mae == pytest.approx(20.5 / 3)
    assert metrics.measured is not None
    assert (metrics.measured.bad1, metrics.measured.mae) == (0, 0)
    assert metrics.paper_rmse == pytest.approx(math.sqrt((4 + 6400) / 3))
    assert metrics.density == pytest.approx(100 / 3)
    nan = evaluate(np.array([[np.nan, np.inf, 20]]), truth)
    assert nan == metrics


def test_sets_without_a_pixel_are_none() -> None:
    truth = truth_of(np.array([[4.0, 5.0]]), np.zeros((1, 2), bool))
    metrics = evaluate(np.array([[4, 5]]), truth, valid=np.zeros((1, 2), bool))
    assert metrics.nonocc is None
    assert metrics.measured is None
    assert metrics.known.bad1 == 100
    assert evaluate(np.array([[4, 5]]), truth_of(np.array([[4.0, 5.0]]))).nonocc is None
    flat = metrics.as_dict()
    assert flat["nonocc_bad1"] is None
    assert flat["measured_rmse"] is None


def test_keys_are_stable() -> None:
    flat = evaluate(np.full((2, 3), 9), from_disparity(np.full((2, 3), 9.0))).as_dict()
    prefixes = ("", "nonocc_", "measured_")
    assert list(flat) == [p + k for p in prefixes for k in KEYS] + ["paper_rmse", "density"]
    json.dumps(flat)


def test_paper_rmse_wraps_a_byte() -> None:
    gray = np.zeros((1, 3), np.float32)
    assert paper_rmse(np.array([[64, 128, 0]]), gray) == 0
    assert paper_rmse(np.array([[63, 63, 63]]), gray) == 252
    assert paper_rmse(np.array([[63, 63, 63]]), gray, first=1) == 0
    assert paper_rmse(np.array([[0, 0, 0]]), gray, first=2) == 8
    assert paper_rmse(np.array([[0, 0, 0]]), gray, first=2, valid=np.zeros((1, 3), bool)) == 0


@pytest.mark.middlebury
def test_a_perfect_venus_scores_39_in_the_paper(middlebury: Path) -> None:
    truth = load("middlebury:venus").truth
    assert truth is not None
    metrics = evaluate(np.rint(truth.disparity).astype(np.uint16), truth)
    assert metrics.paper_rmse == pytest.approx(39.15, abs=0.005)
    assert (metrics.known.bad1, metrics.known.bad2) == (0, 0)
    assert metrics.known.mae <= 0.5


@pytest.mark.middlebury
@pytest.mark.parametrize(("scene", "score"), [("teddy", 47.80), ("cones", 51.69), ("venus", 49.95)])
def test_the_papers_sad_row(middlebury: Path, scene: str, score: float) -> None:
    """Published: 47.77, 51.79, 50.07 (table 2). The paper scored SAD of the left view against the right
    view's truth: 3x3 RGB, d = 0 .. 64, replicated edges, a border of one pixel set to 0."""
    pair = load(f"middlebury:{scene}", "right")
    assert pair.truth is not None
    margin = 65
    left, right = (
        np.pad(image.astype(np.int32), ((1, 1), (margin, 1), (0, 0)), mode="edge")
        for image in (pair.left, pair.right)
    )
    costs = []
    for d in range(65):
        there = right[:, margin - 1 - d : right.shape[1] - d]
        difference = np.abs(left[:, margin - 1 :] - there).sum(2)
        costs.append(np.lib.stride_tricks.sliding_window_view(difference, (3, 3)).sum((2, 3)))
    disparity = np.zeros(pair.left.shape[:2], np.uint16)
    disparity[1:-1, 1:-1] = np.argmin(costs, axis=0)[1:-1, 1:-1]
    assert paper_rmse(disparity, pair.truth.gray) == pytest.approx(score, abs=0.005)


def test_shapes_must_agree() -> None:
    truth = truth_of(np.full((3, 4), 5.0))
    with pytest.raises(InputError, match="map is 5x3, but the truth is 4x3"):
        evaluate(np.zeros((3, 5)), truth)
    with pytest.raises(InputError, match="map is 4x3, but the valid mask is 3x3"):
        evaluate(np.zeros((3, 4)), truth, valid=np.ones((3, 3), bool))
    with pytest.raises(InputError, match="but the truth is"):
        paper_rmse(np.zeros((3, 5)), truth.gray)


def test_unknown_truth() -> None:
    with pytest.raises(InputError, match="no known disparity"):
        evaluate(np.zeros((2, 2)), truth_of(np.full((2, 2), np.nan)))


def test_coverage_counts_what_no_candidate_reaches() -> None:
    truth = from_disparity(np.array([[-0.5, 0, 15, 15.25, np.nan, 40]]))
    found = coverage(truth, 0, 15)
    assert (found.scored, found.outside) == (5, 3)
    assert found.scored_percent == pytest.approx(500 / 6)
    assert found.outside_percent == pytest.approx(60)
    assert "60.00 % of them lie outside 0 .. 15, and count as wrong, not as absent" in str(found)
    assert coverage(truth, -1, 62).outside == 0
    assert "outside" not in str(coverage(truth, -1, 62))


def test_filled_pixels_are_scored_but_not_measured() -> None:
    truth = from_disparity(np.array([[4.0, 4, 4, 4]]))
    given, measured = np.array([[True, True, True, False]]), np.array([[True, False, True, False]])
    found = evaluate(np.array([[4, 9, 6, 4]]), truth, valid=given, measured=measured)
    assert found.known.bad1 == 75
    assert found.measured is not None
    assert (found.measured.bad1, found.measured.mae) == (50, 1)
    assert found.density == 50
