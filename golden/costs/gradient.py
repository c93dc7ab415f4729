"""The criterion `gradient`: differences of the horizontal gradient, summed over a window.

For the pixel (x, y) of the reference view and candidate d,
``D(x, y) = min(|gradient_left(x, y) - gradient_right(x - d, y)|, truncation)``; `neutral` where
``x - d < 0``; 0 outside the image. The value is the sum of D over the rows x columns around (x, y).
"""

from collections.abc import Callable

import numpy as np

from softdepth.golden.costs.sums import along, down, rows_with_zeros
from softdepth.golden.costs.values import Values
from softdepth.golden.front.gradient import BITS, gradient
from softdepth.golden.front.luma import luma
from softdepth.golden.front.pair import Image
from softdepth.spec.criteria import Gradient


class GradientValues:
    """The criterion over a frame; parameters as of `CensusValues`."""

    first_column = 0

    def __init__(self, criterion: Gradient, left: Image, right: Image, bits: int = BITS) -> None:
        self._criterion = criterion
        self._left, self._right = (gradient(luma(view), criterion.cap, bits) for view in (left, right))

    def band(self, first: int, stop: int) -> Callable[[int], Values]:
        """As `CensusValues.band`."""
        criterion, (height, width) = self._criterion, self._left.shape
        reach, beside = criterion.rows // 2, criterion.columns // 2
        above, below = max(first - reach, 0), min(stop + reach, height)
        left, right = self._left[above:below], self._right[above:below]
        kind = np.int16 if criterion.maximum <= np.iinfo(np.int16).max else np.int32
        differences = np.zeros((below - above, width + 2 * beside), kind)

        def values(d: int) -> Values:
            distance = np.abs(left[:, d:] - right[:, : width - d])
            differences[:, beside : beside + d] = criterion.neutral
            differences[:, beside + d : beside + width] = np.minimum(distance, criterion.truncation)
            around = rows_with_zeros(differences[:, d:], first - reach - above, stop + reach - above)
            return along(down(around, criterion.rows), criterion.columns).astype(np.int32)

        return values
