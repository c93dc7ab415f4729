"""The parts of a configuration: criteria and the compensating rule (Bobyr et al. 2021)."""

from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

Reading = Literal["off", "top", "literal"]

CHANNELS = 3
CHANNEL_BITS = 8
LITERAL_INPUT = 1000
"""The value that the compensating rule's literal reading gives every criterion."""


class Frozen(BaseModel):
    """A model that is checked when it is made, and never changes."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Sad(Frozen):
    """Criterion: sum of absolute RGB differences over ``window x window`` pixels (eq. 7).

    The window is centred ``dx`` pixels right of the reference pixel. Memberships have their labels
    at 0, T and 2T with ``T = 2**label_bits``; larger sums saturate at 2T.
    """

    kind: Literal["sad"] = "sad"
    window: int = Field(default=3, ge=1, le=15)
    dx: int = Field(default=0, ge=-16, le=16)
    label_bits: int = Field(default=12, ge=4, le=20)

    @model_validator(mode="after")
    def _odd(self) -> Self:
        if self.window % 2 == 0:
            raise ValueError(f"window is {self.window}, but a window has a centre: use an odd size")
        return self

    @property
    def radius(self) -> int:
        """Pixels from the window's centre to its edge."""
        return self.window // 2

    @property
    def maximum(self) -> int:
        """The largest value the sum can take."""
        return self.window**2 * CHANNELS * (2**CHANNEL_BITS - 1)


# A further criterion is a further model here, told apart by its `kind`.
Criterion = Sad


class Compensation(Frozen):
    """The compensating rule against false near objects (paper, section 4, step 3).

    Candidates with ``d >= min_disparity`` whose SAD exceeds ``threshold`` have all criteria
    replaced: by the top label 2T (``top``) or by 1000 (``literal``). ``criterion`` says which SAD is
    looked at: 0 is the centred 3x3 one of eq. 7, 1 to 3 the criterion of that number. The paper's
    Fig. 4 is met by ``top`` looking at criterion 3.
    """

    reading: Reading = "off"
    threshold: int = Field(default=1200, ge=0)
    min_disparity: int = Field(default=32, ge=0)
    criterion: int = Field(default=0, ge=0, le=3)
