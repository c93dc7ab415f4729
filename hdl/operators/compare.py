"""Which of two words is smaller, and by how much."""

from amaranth.hdl import Const

from softdepth.hdl.adders import add_with_carry
from softdepth.hdl.pipeline import Pipeline, Word
from softdepth.hdl.wires import flag, inverted, wire


def compare(pipeline: Pipeline, a: Word, b: Word) -> tuple[Word, Word]:
    """Whether ``a <= b``, after one operation, and ``|a - b|``, after two.

    ``a - b - 1`` is negative where a is not larger; its complement then is the distance, and elsewhere
    the distance is 1 more.
    """
    difference = pipeline.add(a, inverted(pipeline, b))
    smaller = flag(pipeline, lambda v: v[-1], difference)
    reach = max(a.maximum - b.minimum, b.maximum - a.minimum)
    bits = reach.bit_length()
    folded = wire(
        pipeline,
        lambda v, s: v[:bits] ^ s.replicate(bits),
        difference,
        smaller,
        minimum=0,
        maximum=reach,
    )
    larger = flag(pipeline, lambda s: ~s, smaller)
    zero = Word(Const(0, bits), 0, 0, folded.time)
    return smaller, add_with_carry(pipeline, folded, zero, larger, 0, reach)
