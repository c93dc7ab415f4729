"""What a map scores on a scene, and how scores of many scenes are joined."""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from softdepth.golden.data.truth import Truth

STEPS = 20
"""Points of a sparsification curve."""


class Score(BaseModel):
    """Per cent of the pixels of known disparity that are off by more than 1 and 2 px.

    Members
    -------
    nonocc1, nonocc2 : of those that both views see.
    all1, all2 : of all.
    measured : per cent of all pixels that were measured, not filled; None where that is not known.
    """

    nonocc1: float
    nonocc2: float
    all1: float
    all2: float
    measured: float | None = None

    @property
    def error(self) -> float:
        """The mean of the four."""
        return (self.nonocc1 + self.nonocc2 + self.all1 + self.all2) / 4


class Sparsification(BaseModel):
    """What is left of the error when the least sure of the measured pixels are left out.

    Members
    -------
    bad1 : per cent off by more than 1 px among those kept, as 0, 5, .. 95 % are left out.
    best : the same if the worst errors were left out first.
    area, best_area : the mean of each, over the curve: what a confidence is judged by.
    pixels : how many measured pixels of known disparity there are.
    """

    bad1: list[float]
    best: list[float]
    area: float
    best_area: float
    pixels: int


def score(disparity: NDArray[np.floating], truth: Truth, measured: NDArray[np.bool_] | None = None) -> Score:
    """Score a map in pixels that has a value everywhere."""
    error = np.abs(disparity - np.where(truth.known, truth.disparity, 0))
    assert truth.nonoccluded is not None
    seen = truth.known & truth.nonoccluded

    def bad(pixels: NDArray[np.bool_], limit: float) -> float:
        return float(100 * np.mean(error[pixels] > limit)) if pixels.any() else 0.0

    return Score(
        nonocc1=bad(seen, 1),
        nonocc2=bad(seen, 2),
        all1=bad(truth.known, 1),
        all2=bad(truth.known, 2),
        measured=None if measured is None else float(100 * measured.mean()),
    )


def sparsification(
    disparity: NDArray[np.floating], truth: Truth, measured: NDArray[np.bool_], confidence: NDArray[np.uint8]
) -> Sparsification:
    """Leave out measured pixels by their confidence; of equal ones, in the order of the frame."""
    pixels = truth.known & measured
    error = np.abs(disparity - np.where(truth.known, truth.disparity, 0))[pixels]
    bad1, best = (
        _curve(error, np.argsort(order, kind="stable"))
        for order in (confidence[pixels].astype(np.int32), -error)
    )
    return Sparsification(
        bad1=bad1, best=best, area=float(np.mean(bad1)), best_area=float(np.mean(best)), pixels=error.size
    )


def _curve(error: NDArray[np.floating], order: NDArray[np.intp]) -> list[float]:
    """Bad pixels among those that remain as the first in `order` are left out."""
    ordered = (error > 1)[order]
    starts = [len(ordered) * k // STEPS for k in range(STEPS)]
    return [float(100 * np.mean(ordered[start:])) if len(ordered[start:]) else 0.0 for start in starts]


def by_confidence(
    disparity: NDArray[np.floating], truth: Truth, measured: NDArray[np.bool_], confidence: NDArray[np.uint8]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Of each confidence 0 .. 255: how many measured pixels of known truth, and how many off by > 1 px."""
    pixels = truth.known & measured
    bad = np.abs(disparity - np.where(truth.known, truth.disparity, 0))[pixels] > 1
    levels = confidence[pixels]
    return np.bincount(levels, minlength=256), np.bincount(levels[bad], minlength=256)


def geometric_mean(ratios: Iterable[float]) -> float:
    """The geometric mean of positive numbers; 0 counts as a thousandth."""
    logs = [math.log(max(ratio, 1e-3)) for ratio in ratios]
    return math.exp(sum(logs) / len(logs))
