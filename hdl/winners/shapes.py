"""How wide costs are behind the lanes: each is ``num / den``."""

from amaranth.hdl import Shape, unsigned
from amaranth.lib import data
from amaranth.lib.wiring import In, Member, Out


def cost_bits(maximum: int) -> int:
    """Bits of a sum, with room for a larger value than any, all ones, which stands for none."""
    return (maximum + 1).bit_length()


def sum_layout(maximum: int) -> data.StructLayout:
    """Layout of a sum up to `maximum`: a plain number has no ``den``, which then counts as 1."""
    return data.StructLayout({"num": unsigned(cost_bits(maximum)), "den": unsigned(0)})


def is_fraction(cost: data.StructLayout) -> bool:
    """Whether a cost of this layout has a denominator."""
    return Shape.cast(cost.members["den"]).width > 0


def right_winner_members(lanes: int, steps: int, cost: data.StructLayout) -> dict[str, Member]:
    """The members of a component that finds the right view's winner; `RightNumbers` says what they mean."""
    return {
        "valid": In(1),
        "first": In(1),
        "last": In(1),
        "step": In(range(steps)),
        "costs": In(data.ArrayLayout(cost, lanes)),
        "excluded": In(lanes),
        "winner": Out(range(lanes * steps)),
    }
