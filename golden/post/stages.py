"""The stages after the winners, in their order; this file is the specification of their sequence.

1. ``winner``: the left winner, with the code of `borders.validity_codes`.
2. ``check``: results that `left_right.consistent` does not confirm become INCONSISTENT.
3. ``island``: those that fail `island.on_an_island` become ISLAND.
4. ``sixteenths``: the remaining ones get their fraction of a pixel. From here on, pixels without a result
   are 0.
5. ``fill``: all others, the border band included, are filled, and become FILLED; in a row without a valid
   result they are 0 and become NOTHING.
6. ``median``, then 7. ``masked median along the row`` and 8. ``masked median down the column``. They change
   no codes. If `fill` is on, every pixel takes part, as 0 if it is NOTHING; otherwise only valid ones do.

Stages that the configuration leaves out are skipped. A result's confidence is its winner's, and 0 unless it
was measured.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.gradient import BITS
from softdepth.golden.front.pair import Image
from softdepth.golden.post.fill import fill
from softdepth.golden.post.island import on_an_island
from softdepth.golden.post.left_right import consistent
from softdepth.golden.post.masked_median import both
from softdepth.golden.post.median import median
from softdepth.golden.post.sixteenths import sixteenths
from softdepth.golden.winners.frame import Winners
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


class Stage(NamedTuple):
    """A frame as one stage leaves it: rows x columns of disparities and codes."""

    name: str
    disparity: NDArray[np.uint16]
    code: NDArray[np.uint8]


def stages(
    config: Config, found: Winners, codes: NDArray[np.uint8], image: Image, bits: int = BITS
) -> list[Stage]:
    """The frame after each stage, in the core's view; `image` is the reference view."""
    post = config.post
    code = codes
    measured = code < Validity.BORDER
    values = np.where(measured, found.left, np.uint16(0))
    done = [Stage("winner", values, code)]
    if post.check:
        lost = measured & ~consistent(found.left, found.right, post.tolerance)
        done.append(_without(done[-1], "check", lost, Validity.INCONSISTENT))
    if post.island:
        lost = on_an_island(
            done[-1].code < Validity.BORDER, post.island, post.island_rows, post.island_columns
        )
        done.append(_without(done[-1], "island", lost, Validity.ISLAND))
    code = done[-1].code
    measured = code < Validity.BORDER
    if post.fraction_bits:
        done.append(Stage("sixteenths", np.where(measured, sixteenths(found), np.uint16(0)), code))
    taking_part = measured
    if post.fill:
        taking_part = np.ones(code.shape, bool)
        reason = np.where(measured.any(axis=1), Validity.FILLED, Validity.NOTHING).astype(np.uint8)
        code = np.where(measured, code, reason[:, None])
        done.append(Stage("fill", fill(done[-1].disparity, measured), code))
    if post.median:
        done.append(Stage("median", median(done[-1].disparity, taking_part), code))
    if post.masked_median:
        for name, values in both(done[-1].disparity, taking_part, image, post, bits):
            done.append(Stage(f"masked median {name}", values, code))
    return done


def _without(before: Stage, name: str, lost: NDArray[np.bool_], why: Validity) -> Stage:
    """The frame without the results that a stage has taken away."""
    code = np.where(lost, np.uint8(why), before.code)
    return Stage(name, np.where(lost, np.uint16(0), before.disparity), code)
