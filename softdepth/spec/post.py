"""What happens to a frame's disparities after the winners: checks, filling, filters."""

from typing import Any, Literal, Self

from pydantic import Field, model_validator

from softdepth.spec.frozen import Frozen

ISLAND_BITS = 5
"""Of the number of pixels in the island test's window, which a register holds."""
LIKE_MAX = 256
"""With it, all colours are alike."""
MEDIAN_REACH = 2
"""Rows and columns around a pixel that the median takes: 5x5."""
MASKED_REACH = 15
"""The farthest that the masked medians reach."""
LATER = ("island_rows", "island_columns", "masked_spacing", "masked_rows", "colour_bits")
"""Keys that came later: at their defaults, they do not change the hash of a configuration."""


class Post(Frozen):
    """The stages after the winners, in this order; by default none of them.

    Parameters
    ----------
    check : left-right check. A result d of pixel x holds where the right view's winner at x - d is at
        most `tolerance` from d; else it is invalid (`Validity.INCONSISTENT`).
    island : fewer valid results than this in the pixels around, centre and replicated edges counted, make a
        result invalid (`Validity.ISLAND`). 0 is off.
    island_rows, island_columns : how many rows and columns around are looked at.
    fraction_bits : 4 gives disparities in sixteenths of a pixel, by two lines of equal and opposite slope.
    fill : invalid results become the smaller of the nearest valid ones left and right in the row
        (`Validity.FILLED`); in a row without any they are 0 (`Validity.NOTHING`).
    median : 5 is the median of the 5x5 pixels around, edges replicated. 0 is off.
    masked_median : reach of the lower median of those pixels in the row, and then in the column, whose
        colour differs from the centre's by less than `like` in every channel. 0 is off.
    masked_spacing : along the row, only every so many-th pixel counts, from the centre on; at most
        `masked_median`.
    masked_rows : reach down the column; at most `masked_median`.
    like : in units of 8-bit values.
    colour_bits : bits of each channel that are compared, the highest; all, where a pixel has no more.
    confidence : results carry eight bits, the winner's margin over the best candidate that is not its
        neighbour: ``min(255, margin >> Config.confidence_shift)``, 0 where nothing was measured.
    """

    check: bool = False
    tolerance: int = Field(default=0, ge=0, le=15)
    island: int = Field(default=0, ge=0)
    island_rows: Literal[1, 3, 5] = 5
    island_columns: Literal[1, 3, 5, 7, 9] = 5
    fraction_bits: Literal[0, 4] = 0
    fill: bool = False
    median: Literal[0, 5] = 0
    masked_median: int = Field(default=0, ge=0, le=MASKED_REACH)
    masked_spacing: int = Field(default=1, ge=1, le=4)
    masked_rows: int = Field(default=MASKED_REACH, ge=1, le=MASKED_REACH)
    like: int = Field(default=32, ge=1, le=LIKE_MAX)
    colour_bits: int = Field(default=12, ge=1, le=12)
    confidence: bool = False

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.tolerance and not self.check:
            raise ValueError(f"tolerance is {self.tolerance} without a check: use check = true, or 0")
        pixels, most = self.island_rows * self.island_columns, (1 << ISLAND_BITS) - 1
        if self.island and pixels > most:
            raise ValueError(
                f"island_rows x island_columns is {pixels} pixels: use at most {most}, for example 3 x 9"
            )
        if self.island > pixels:
            raise ValueError(
                f"island is {self.island}, but there are {self.island_rows} x {self.island_columns} pixels"
                f" around: use at most {pixels}"
            )
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

    def shaping(self) -> dict[str, Any]:
        """All that shapes the stages, as plain data, without keys of `LATER` that are as they always were."""
        data = self.model_dump(mode="json")
        fields = type(self).model_fields
        return {k: v for k, v in data.items() if k not in LATER or v != fields[k].default}

    @property
    def below(self) -> int:
        """Rows below a pixel that its result depends on, beyond those of its cost."""
        return self.island_reach[0] + (MEDIAN_REACH if self.median else 0) + self.masked_reach[0]

    @property
    def island_reach(self) -> tuple[int, int]:
        """Rows and columns that the island test reaches on either side."""
        return (self.island_rows // 2, self.island_columns // 2) if self.island else (0, 0)

    @property
    def masked_reach(self) -> tuple[int, int]:
        """Rows and columns that the masked medians reach on either side."""
        return min(self.masked_rows, self.masked_median), self.masked_median

    @property
    def masked_step(self) -> int:
        """Columns between those that count along the row."""
        return min(self.masked_spacing, max(self.masked_median, 1))

    @property
    def masked_along(self) -> tuple[int, ...]:
        """The columns that count along the row, relative to the pixel's own, ascending."""
        taps = self.masked_median // self.masked_step
        return tuple(self.masked_step * k for k in range(-taps, taps + 1))

    @property
    def masked_down(self) -> tuple[int, ...]:
        """The rows that count down the column, likewise."""
        reach = self.masked_reach[0]
        return tuple(range(-reach, reach + 1))
