"""The criterion `census`: Hamming distances summed down columns, and over columns of like colour.

For the pixel (x, y) of the reference view and candidate d:

1. ``H(x, y) = popcount(census_left(x, y) ^ census_right(x - d, y))``; `neutral` where ``x - d < 0``; 0
   outside the image.
2. ``C(x, y)``: the sum of H over the `rows` rows around y (a running sum down the column).
3. The support: those columns ``x + t``, t of `offsets`, that lie in the image and are like the pixel in the
   colour of the reference view (`likeness`), which the pixel itself always is. With n of them, and S the
   sum of their C(x + t, y), the value is ``S * reciprocals[n] >> SUPPORT_SHIFT``.
"""

from collections.abc import Callable

import numpy as np

from softdepth.golden.costs.sums import down, rows_with_zeros
from softdepth.golden.costs.values import Values
from softdepth.golden.front.census import census
from softdepth.golden.front.gradient import BITS
from softdepth.golden.front.likeness import alike_beside
from softdepth.golden.front.luma import luma
from softdepth.golden.front.pair import Image
from softdepth.spec.criteria import SUPPORT_SHIFT, Census


class CensusValues:
    """The criterion over a frame: descriptors and supports, made once.

    Parameters
    ----------
    left, right : rows x columns x channels, `left` the reference view.
    bits : of a channel.
    """

    first_column = 0

    def __init__(self, criterion: Census, left: Image, right: Image, bits: int = BITS) -> None:
        self._criterion = criterion
        self._left, self._right = census(luma(left)), census(luma(right))
        counts = np.stack([alike_beside(left, offset, criterion.like, bits) for offset in criterion.offsets])
        self._counts = -counts.astype(np.int16)  # all ones where a column counts
        table = np.array((0, *criterion.reciprocals), np.int32)
        self._reciprocal = table[counts.sum(axis=0)]

    def band(self, first: int, stop: int) -> Callable[[int], Values]:
        """The function from a candidate d to the values of rows ``first .. stop - 1``.

        They are (stop - first) x (width - d): those of the columns from d on.
        """
        criterion, (height, width) = self._criterion, self._left.shape
        reach, beside = criterion.rows // 2, criterion.offsets[-1]
        above, below = max(first - reach, 0), min(stop + reach, height)
        left, right = self._left[above:below], self._right[above:below]
        counts = self._counts[:, first:stop]
        reciprocal = self._reciprocal[first:stop]
        # Of a column without a partner, every row that lies in the image is neutral.
        there = rows_with_zeros(np.ones((height, 1), np.int16), first - reach, stop + reach)
        neutral = criterion.neutral * down(there, criterion.rows)
        columns = np.zeros((stop - first, width + 2 * beside), np.int16)

        def values(d: int) -> Values:
            hamming = np.bitwise_count(left[:, d:] ^ right[:, : width - d]).astype(np.int16)
            hamming = rows_with_zeros(hamming, first - reach - above, stop + reach - above)
            columns[:, beside : beside + d] = neutral
            columns[:, beside + d : beside + width] = down(hamming, criterion.rows)
            total = np.zeros((stop - first, width - d), np.int16)
            for count, offset in zip(counts, criterion.offsets, strict=True):
                start = beside + d + offset
                total += count[:, d:] & columns[:, start : start + width - d]
            return total * reciprocal[:, d:] >> SUPPORT_SHIFT

        return values
