"""The right view's winner, by the kind of cost."""

from amaranth.lib import data

from softdepth.hdl.costs.layout import is_fraction
from softdepth.hdl.winners.right_fractions import RightFractions
from softdepth.hdl.winners.right_numbers import RightNumbers


def right_winner(lanes: int, steps: int, cost: data.StructLayout) -> RightNumbers | RightFractions:
    """A component with `right_winner_members`; numbers are compared in one clock, fractions in several."""
    return (RightFractions if is_fraction(cost) else RightNumbers)(lanes, steps, cost)
