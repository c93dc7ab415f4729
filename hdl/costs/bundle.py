"""What the costs pass to the winners: the only interface between the two."""

from amaranth.hdl import Module, ShapeLike, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Member, Out

FORTH = ("begins", "valid", "first", "last", "step", "costs", "excluded", "tags")
"""What the costs say; `credit` goes the other way."""


def cost_ports(*, lanes: int, steps: int, cost: ShapeLike, tags: ShapeLike) -> dict[str, Member]:
    """Ports of a component that judges ``lanes`` candidates a clock; winners have them the other way round.

    Nothing here can be held back: a pixel is begun only when there is ``credit``.

    Members
    -------
    credit : another result may be begun.
    begins : a result is begun, a fixed time before its first costs (``latency`` of the costs).
    valid, first, last, step : a step's costs are there, and the step's position within the pixel.
    costs, excluded : of each lane's candidate, `right_columns.candidate`.
    tags : what else is known about the result, in the same clock or a fixed time before
        (``tags_ahead`` of the costs).
    """
    return {
        "credit": In(1),
        "begins": Out(1),
        "valid": Out(1),
        "first": Out(1),
        "last": Out(1),
        "step": Out(range(steps)),
        "costs": Out(data.ArrayLayout(cost, lanes)),
        "excluded": Out(lanes),
        "tags": Out(tags),
    }


def winner_ports(*, lanes: int, steps: int, cost: ShapeLike, tags: ShapeLike) -> dict[str, Member]:
    """`cost_ports` as the winners see them."""
    ports = cost_ports(lanes=lanes, steps=steps, cost=cost, tags=tags)
    return {name: member.flip() for name, member in ports.items()}


def join(m: Module, costs: wiring.Component, winners: wiring.Component) -> None:
    """Connect costs to winners."""
    m.d.comb += costs.credit.eq(winners.credit)  # type: ignore[attr-defined]
    for name in FORTH:
        m.d.comb += Value.cast(getattr(winners, name)).eq(Value.cast(getattr(costs, name)))
