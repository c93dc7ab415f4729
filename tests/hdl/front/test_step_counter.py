"""StepCounter: each pixel its steps, and no pixel before its turn or without a credit."""

from random import Random

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.front.step_counter import StepCounter
from tests.support.simulation import simulate


@pytest.mark.parametrize("steps", [1, 2, 3, 8])
def test_every_pixel_gets_its_steps(steps: int) -> None:
    dut = StepCounter(steps)
    random = Random(steps)
    loads: list[int] = []
    taken: list[tuple[int, int, int, int]] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        credit_before = True
        for clock in range(200):
            held = ctx.get(dut.held)
            if clock:
                going = bool(loads) and clock - loads[-1] < steps
                assert held == (going or not credit_before)
            load = not held and random.random() < 0.7
            credit_before = random.random() < 0.8
            ctx.set(dut.load, load)
            ctx.set(dut.credit, credit_before)
            if load:
                loads.append(clock)
            _, _, valid, first, last, step = await ctx.tick().sample(dut.valid, dut.first, dut.last, dut.step)
            if valid:
                taken.append((clock, first, last, step))

    simulate(dut, bench)
    expected = [(at + 1 + k, k == 0, k == steps - 1, k) for at in loads for k in range(steps)]
    assert taken == expected[: len(taken)]
    assert len(expected) - len(taken) <= steps
    assert len(loads) > 150 // (2 * steps)
