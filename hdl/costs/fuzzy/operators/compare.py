"""Which of two words is smaller, and by how much."""

from softdepth.hdl.arithmetic.adders import distance
from softdepth.hdl.arithmetic.word import Word


def compare(a: Word, b: Word) -> tuple[Word, Word]:
    """Whether ``a <= b``, after one operation, and ``|a - b|``, after two.

    ``a - b - 1`` is negative where a is not larger.
    """
    difference = a + b.inverted
    smaller = difference.negative
    reach = max(a.maximum - b.minimum, b.maximum - a.minimum)
    return smaller, distance(difference, smaller, reach.bit_length(), reach)
