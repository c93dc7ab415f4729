"""Slots: a frame takes those that it is said to, and none more."""

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.front.slots import Slots
from tests.support.simulation import simulate

WIDTH, HEIGHT, FRAMES = 5, 3, 3


def starts(slots: Slots, below: int) -> list[int]:
    """The clocks in which frames begin that wait on offer."""
    lines = [(y, x) for y in range(HEIGHT + below) for x in range(WIDTH)]
    found: list[int] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        payload, clock = slots.i.payload, 0
        ctx.set(slots.credit, 1)
        ctx.set(slots.i.valid, 1)
        for y, x in lines * FRAMES:
            begins = (y, x) == (0, 0)
            ctx.set(payload.sof, begins)
            ctx.set(payload.eol, x == WIDTH - 1)
            ctx.set(payload.eof, (y, x) == (HEIGHT - 1, WIDTH - 1))
            taken = 0
            while not taken:
                _, _, taken = await ctx.tick().sample(slots.i.ready)
                clock += 1
            if begins:
                found.append(clock)

    simulate(slots, bench)
    return found


@pytest.mark.parametrize(("steps", "right", "drain"), [(1, 2, 1), (2, 1, 2), (2, 1, 5), (3, 2, 4)])
def test_a_frame_takes_its_slots_and_those_beyond(steps: int, right: int, drain: int) -> None:
    below = 2
    slots = Slots(1, steps, 8, right=right, below=below, history=3, drain=drain)
    clocks = steps * ((WIDTH + right) * (HEIGHT + below) + drain)
    first, *others = starts(slots, below)
    assert others == [first + clocks * (k + 1) for k in range(FRAMES - 1)]
