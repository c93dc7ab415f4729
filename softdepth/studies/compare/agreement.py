"""How far two disparity maps of one frame are from each other."""

from typing import TYPE_CHECKING

import numpy as np
from pydantic import BaseModel

from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.truth import Truth
    from softdepth.golden.maps import DisparityMap


class Agreement(BaseModel):
    """The difference of two maps over the pixels in which both have a result.

    Members
    -------
    pixels : how many those are.
    differ, differ1, differ2 : per cent of them that differ at all, by more than 1 and by more than 2 px.
    mae, rmse : mean absolute and root mean square difference, in pixels.
    closer, farther : per cent of the pixels that differ and have a known truth, in which the first map
        is nearer to it than the second, and in which it is less near; None without truth or difference.
    """

    pixels: int
    differ: float
    differ1: float
    differ2: float
    mae: float
    rmse: float
    closer: float | None = None
    farther: float | None = None


def agreement(first: "DisparityMap", second: "DisparityMap", truth: "Truth | None" = None) -> Agreement:
    """Compare two maps; with `truth`, also which of them is nearer to it where they differ.

    Raises `InputError` for maps of different size, or without a common pixel.
    """
    if first.shape != second.shape:
        raise InputError(f"the maps are {first.shape} and {second.shape}", "compare maps of the same frame")
    common = first.valid & second.valid
    if not common.any():
        raise InputError("no pixel has a result in both maps", "give images larger than the window support")
    a, b = first.disparity.astype(np.int64), second.disparity.astype(np.int64)
    distance = np.abs(a - b)[common]
    differ, differ1, differ2 = (float(100 * np.mean(distance > limit)) for limit in (0, 1, 2))
    found = Agreement(
        pixels=distance.size,
        differ=differ,
        differ1=differ1,
        differ2=differ2,
        mae=float(distance.mean()),
        rmse=float(np.sqrt(np.mean(distance**2))),
    )
    if truth is None or not (disputed := common & (a != b) & truth.known).any():
        return found
    known = truth.disparity.astype(np.float64)[disputed]
    gain = np.abs(b[disputed] - known) - np.abs(a[disputed] - known)
    return found.model_copy(
        update={"closer": float(100 * np.mean(gain > 0)), "farther": float(100 * np.mean(gain < 0))}
    )
