"""What happens to a frame's disparities after the winners: checks, filling, filters."""

from typing import Literal, Self

from pydantic import Field, model_validator

from softdepth.spec.frozen import Frozen

ISLAND_REACH = 2
"""Rows and columns around a pixel that the island test looks at: 5x5."""
LIKE_MAX = 256
"""With it, all colours are alike."""
MEDIAN_REACH = 2
"""The same of the median."""


class Post(Frozen):
    """The stages after the winners, in this order; by default none of them.

    Parameters
    ----------
    check : left-right check. A result d of pixel x holds where the right view's winner at x - d is at
        most `tolerance` from d; else it is invalid (`Validity.INCONSISTENT`).
    island : fewer valid results than this in the 5x5 pixels around, centre and replicated edges counted,
        make a result invalid (`Validity.ISLAND`). 0 is off.
    fraction_bits : 4 gives disparities in sixteenths of a pixel, by two lines of equal and opposite slope.
    fill : invalid results become the smaller of the nearest valid ones left and right in the row
        (`Validity.FILLED`); in a row without any they are 0 (`Validity.NOTHING`).
    median : 5 is the median of the 5x5 pixels around, edges replicated. 0 is off.
    masked_median : reach of the lower median of those pixels in the row, and then in the column, whose
        colour differs from the centre's by less than `like` in every channel. 0 is off.
    like : in units of 8-bit values.
    confidence : results carry eight bits, the winner's margin over the best candidate that is not its
        neighbour: ``min(255, margin >> Config.confidence_shift)``, 0 where nothing was measured.
    """

    check: bool = False
    tolerance: int = Field(default=0, ge=0, le=15)
    island: int = Field(default=0, ge=0, le=(2 * ISLAND_REACH + 1) ** 2)
    fraction_bits: Literal[0, 4] = 0
    fill: bool = False
    median: Literal[0, 5] = 0
    masked_median: int = Field(default=0, ge=0, le=15)
    like: int = Field(default=32, ge=1, le=LIKE_MAX)
    confidence: bool = False

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.tolerance and not self.check:
            raise ValueError(f"tolerance is {self.tolerance} without a check: use check = true, or 0")
        return self

    @property
    def any(self) -> bool:
        """Some stage is on."""
        return bool(
            self.check
            or self.island
            or self.fraction_bits
            or self.fill
            or self.median
            or self.masked_median
            or self.confidence
        )

    @property
    def below(self) -> int:
        """Rows below a pixel that its result depends on, beyond those of its cost."""
        island = ISLAND_REACH if self.island else 0
        return island + (MEDIAN_REACH if self.median else 0) + self.masked_median
