"""Points that both views show: SIFT keypoints, matched both ways within a band of rows."""

from dataclasses import dataclass

import cv2
import numpy as np

from softdepth.inspect.reduced import Reduced

KEYPOINTS = 1500
BAND = 40
"""Rows up and down in which a match is looked for, in pixels of the reduced pair: 16 of an offset, and what a
rotation by a degree adds at the ends of a row."""
SHARE_OF_WIDTH = 0.5
"""The largest disparity looked for, either way."""
RATIO = 0.85
"""A match is this much nearer than the next one elsewhere (Lowe 2004 takes 0.8 for the whole image; a band
holds fewer rivals)."""
FARTHEST = 0.6
"""Largest squared distance of two unit descriptors that may be one point."""

_NEVER = 9.0  # beyond any squared distance of unit vectors
_SAME_PLACE = 3.0  # SIFT gives a point of two orientations twice: these are no rivals
_CONTRAST = 0.01  # a quarter of OpenCV's default: weak texture is what many rooms have


@dataclass(frozen=True, eq=False)
class Points:
    """Matched points, float32 N x 2 each, columns before rows, in pixels of the reduced pair.

    `found` is how many keypoints the view with fewer of them has.
    """

    left: np.ndarray
    right: np.ndarray
    found: int

    def __len__(self) -> int:
        return len(self.left)

    @property
    def disparity(self) -> np.ndarray:
        """Columns from the right view's point to the left view's, N."""
        return self.left[:, 0] - self.right[:, 0]

    @property
    def rows(self) -> np.ndarray:
        """Rows from the left view's point down to the right view's, N."""
        return self.right[:, 1] - self.left[:, 1]

    def only(self, chosen: np.ndarray) -> "Points":
        """Those that a mask or an index chooses."""
        return Points(self.left[chosen], self.right[chosen], self.found)


def match(pair: Reduced) -> Points:
    """The points that each view finds in the other, mutually and without a rival."""
    left, left_words = _keypoints(pair.left)
    right, right_words = _keypoints(pair.right)
    found = min(len(left), len(right))
    if found < 2:
        return Points(left[:0], right[:0], found)
    distance = 2 - 2 * left_words @ right_words.T
    far = (_apart(left, right, 1) > BAND) | (_apart(left, right, 0) > SHARE_OF_WIDTH * pair.width)
    distance[far] = _NEVER
    nearest = distance.argmin(axis=1)
    mutual = distance.argmin(axis=0)[nearest] == np.arange(len(left))
    chosen = np.flatnonzero(mutual & (distance.min(axis=1) < FARTHEST))
    nearest, distance = nearest[chosen], distance[chosen]
    best = distance[np.arange(len(chosen)), nearest]
    place = right[nearest]
    distance[(_apart(place, right, 0) < _SAME_PLACE) & (_apart(place, right, 1) < _SAME_PLACE)] = _NEVER
    good = best < RATIO**2 * distance.min(axis=1, initial=_NEVER)
    return Points(left[chosen[good]], place[good], found)


def supported(points: Points, neighbours: int = 8, needed: int = 3) -> np.ndarray:
    """bool N: points whose disparity `needed` of their nearest `neighbours` share, to 2 pixels or 8 %."""
    if len(points) <= neighbours:
        return np.zeros(len(points), bool)
    away = _apart(points.left, points.left, 0) ** 2 + _apart(points.left, points.left, 1) ** 2
    near = np.argpartition(away, neighbours, axis=1)[:, : neighbours + 1]
    disparity = points.disparity
    tolerance = np.maximum(2.0, 0.08 * np.abs(disparity))
    agree = np.abs(disparity[near] - disparity[:, None]) <= tolerance[:, None]
    return agree.sum(axis=1) - 1 >= needed  # each point is among its own nearest


def _apart(these: np.ndarray, those: np.ndarray, axis: int) -> np.ndarray:
    """How far each of `these` is from each of `those` along an axis, N x M."""
    return np.abs(these[:, None, axis] - those[None, :, axis])


def _keypoints(view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (N x 2) and unit descriptors (N x 128)."""
    sift = cv2.SIFT_create(nfeatures=KEYPOINTS, contrastThreshold=_CONTRAST)  # pyright: ignore[reportAttributeAccessIssue]
    points, words = sift.detectAndCompute(view, None)
    if words is None:
        return np.zeros((0, 2), np.float32), np.zeros((0, 128), np.float32)
    length = np.linalg.norm(words, axis=1, keepdims=True)
    return np.array([point.pt for point in points], np.float32), words / np.maximum(length, np.float32(1e-6))
