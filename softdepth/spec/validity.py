"""Why a result is or is not a measurement: the code that travels with every disparity."""

from enum import IntEnum


class Validity(IntEnum):
    """The code beside every disparity, the same in the models and the gateware.

    It has `Config.code_bits` bits: two where only the first three can occur, else three. A result is a
    measurement when its code is below `BORDER`. Where there is neither measurement nor filling, the
    disparity is 0.
    """

    meaning: str

    def __new__(cls, value: int, meaning: str) -> "Validity":
        code = int.__new__(cls, value)
        code._value_ = value
        code.meaning = meaning
        return code

    FULL = 0, "All candidates were compared."
    PARTIAL = 1, "Some candidates were excluded, because their window, or partner, leaves the other image."
    BORDER = 2, "No result: the support leaves the reference image."
    FILLED = 3, "Not measured; the disparity is that of a neighbour in the row."
    INCONSISTENT = 4, "No result: the right view's winner is another. Most such pixels are occluded."
    ISLAND = 5, "No result: too few of the neighbours have one."
    NOTHING = 6, "No result: nothing to compare, or no result in the row that could fill this pixel."
