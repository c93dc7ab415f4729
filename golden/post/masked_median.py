"""The colour-masked median: among the pixels of a run that are like the centre, the lower median.

Of the pixels in the row at some offsets from a pixel, 0 among them, those count that lie in the image, have a
similar colour in the reference view (`likeness`), and are valid; of these n, rank ``(n - 1) // 2`` is taken.
Invalid results are left unchanged. Down the column, the same is done to the transposed picture.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.gradient import BITS
from softdepth.golden.front.likeness import alike_beside, coarse
from softdepth.golden.front.pair import Image
from softdepth.golden.post.rank import MISSING, lower_median
from softdepth.spec.post import Post

BAND_ROWS = 64


def along_row(
    values: NDArray[np.uint16],
    valid: NDArray[np.bool_],
    image: Image,
    offsets: Sequence[int],
    like: int,
    bits: int = BITS,
) -> NDArray[np.uint16]:
    """Rows x columns in and out; `image` is the reference view, rows x columns x channels of `bits` bits."""
    height, width = values.shape
    reach = max(offsets)
    out = values.copy()
    for y in range(0, height, BAND_ROWS):
        rows = slice(y, min(y + BAND_ROWS, height))
        around = np.pad(
            np.where(valid[rows], values[rows], MISSING), ((0, 0), (reach, reach)), constant_values=MISSING
        )
        samples = np.empty((*values[rows].shape, len(offsets)), np.uint16)
        for k, offset in enumerate(offsets):
            counts = alike_beside(image[rows], offset, like, bits)
            samples[:, :, k] = np.where(counts, around[:, reach + offset : reach + offset + width], MISSING)
        np.copyto(out[rows], lower_median(samples), where=valid[rows])
    return out


def down_column(
    values: NDArray[np.uint16],
    valid: NDArray[np.bool_],
    image: Image,
    offsets: Sequence[int],
    like: int,
    bits: int = BITS,
) -> NDArray[np.uint16]:
    """As `along_row`, in the other direction."""
    return along_row(values.T, valid.T, image.transpose(1, 0, 2), offsets, like, bits).T


def both(
    values: NDArray[np.uint16], valid: NDArray[np.bool_], image: Image, post: Post, bits: int = BITS
) -> Iterator[tuple[str, NDArray[np.uint16]]]:
    """The medians that `post` asks for, one after the other: a name, and the values after it."""
    image = coarse(image, post.colour_bits, bits)
    for name, direction, offsets in (
        ("along the row", along_row, post.masked_along),
        ("down the column", down_column, post.masked_down),
    ):
        values = direction(values, valid, image, offsets, post.like, bits)
        yield name, values
