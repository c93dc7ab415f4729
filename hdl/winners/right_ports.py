"""What both kinds of right winners have at their outside."""

from amaranth.lib import data
from amaranth.lib.wiring import In, Member, Out


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
