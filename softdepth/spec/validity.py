"""Why a result is or is not a measurement: the code that travels with every disparity."""

from enum import IntEnum


class Validity(IntEnum):
    """The two-bit code beside every disparity, the same in the models and the gateware.

    A result is a measurement when its code is below `BORDER`. Where it is not, the disparity is 0.
    """

    FULL = 0
    """All candidates ``0 .. disparities - 1`` were compared."""
    PARTIAL = 1
    """Some candidates were excluded, because their window leaves the other image."""
    BORDER = 2
    """No result: the support leaves the reference image."""
