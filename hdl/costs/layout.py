"""How wide a cost that is a sum is, and what is asked of any: each is ``num / den``."""

from amaranth.hdl import Shape, unsigned
from amaranth.lib import data


def cost_bits(maximum: int) -> int:
    """Bits of a sum, with room for a larger value than any, all ones, which stands for none."""
    return (maximum + 1).bit_length()


def sum_layout(maximum: int) -> data.StructLayout:
    """Layout of a sum up to `maximum`: a plain number has no ``den``, which then counts as 1."""
    return data.StructLayout({"num": unsigned(cost_bits(maximum)), "den": unsigned(0)})


def is_fraction(cost: data.StructLayout) -> bool:
    """Whether a cost of this layout has a denominator."""
    return Shape.cast(cost.members["den"]).width > 0
