"""Every candidate of every pixel, in bands of rows that stay in a processor's cache."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from softdepth.golden.costs.criteria import FrameCriteria, Values
from softdepth.golden.front.pair import Image
from softdepth.spec.config import Config

BAND_PIXELS = 16384
"""Pixels of a band. The models keep some thirty numbers per pixel: this many fit a level-2 cache."""


@dataclass(frozen=True)
class Band:
    """Consecutive rows of the pixels that have a result.

    Members
    -------
    rows, columns : the pixels' place in the frame.
    criteria : the function from a candidate to its criteria.
    """

    config: Config
    rows: slice
    columns: slice
    criteria: Callable[[int], list[Values]]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns with a result."""
        return self.rows.stop - self.rows.start, self.columns.stop - self.columns.start

    def candidates(self) -> Iterator[tuple[int, list[Values]]]:
        """Each candidate d, ascending, with its criteria.

        Criteria are rows x (columns - d): candidate d is excluded in the first d columns, where its
        window would leave the other image. Candidates that no pixel has are skipped.
        """
        _, columns = self.shape
        for d in range(min(self.config.disparities, columns)):
            yield d, self.criteria(d)


def bands(left: Image, right: Image, config: Config) -> Iterator[Band]:
    """The pixels with a result, top to bottom; none when the image is smaller than the support."""
    height, width, _ = left.shape
    first, stop = config.reach_rows, height - config.reach_rows
    step = max(1, BAND_PIXELS // width)
    if width > config.reach_left + config.reach_right and first < stop:
        criteria = FrameCriteria(config, left, right)
        for y in range(first, stop, step):
            yield _band(criteria, left, config, y, min(y + step, stop))


def band(left: Image, right: Image, config: Config, first: int, stop: int) -> Band:
    """The band of rows ``first .. stop - 1``, all of them within the border."""
    height, width, _ = left.shape
    assert config.reach_rows <= first < stop <= height - config.reach_rows
    assert width > config.reach_left + config.reach_right
    return _band(FrameCriteria(config, left, right), left, config, first, stop)


def _band(criteria: FrameCriteria, left: Image, config: Config, first: int, stop: int) -> Band:
    columns = slice(config.reach_left, left.shape[1] - config.reach_right)
    return Band(config, slice(first, stop), columns, criteria.band(first, stop))
