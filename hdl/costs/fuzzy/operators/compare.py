"""Which of two words is smaller, and by how much."""

from softdepth.hdl.arithmetic.adders import magnitude
from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.arithmetic.wires import flag, inverted


def compare(pipeline: Pipeline, a: Word, b: Word) -> tuple[Word, Word]:
    """Whether ``a <= b``, after one operation, and ``|a - b|``, after two.

    ``a - b - 1`` is negative where a is not larger.
    """
    difference = pipeline.add(a, inverted(pipeline, b))
    smaller = flag(pipeline, lambda v: v[-1], difference)
    reach = max(a.maximum - b.minimum, b.maximum - a.minimum)
    return smaller, magnitude(pipeline, difference, smaller, reach.bit_length(), reach)
