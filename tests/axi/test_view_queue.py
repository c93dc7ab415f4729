"""ViewQueue: nothing is lost, doubled or out of order, at any phase of its two clocks, and across a reset."""

from random import Random

import pytest
from amaranth.hdl import ClockDomain, Module, Signal
from amaranth.sim import Simulator, SimulatorContext

from softdepth.hdl.axi.view_queue import ViewQueue
from tests.support.mutations import mutated
from tests.support.simulation import simulate

BITS, DEPTH = 12, 9
PERIOD = 1e-6


def carried(seed: int, *, pixels: int = 90, reset: bool = False, block: type[ViewQueue] = ViewQueue) -> None:
    """Pixels cross from a clock of random period, phase and jitter; with a reset, those behind it do.

    A clock period is 0.4 to 2.5 of the reader's, and each of its edges comes up to a fifth early or late.
    """
    random = Random(seed)
    queue = block(BITS, DEPTH, own_clock=True)
    top, domain = Module(), ClockDomain("sync")
    top.domains.sync = domain
    top.submodules.queue = queue
    period = PERIOD * 0.4 * 6.25 ** random.random()
    i_rate, o_rate = random.choice((1, 0.5)), random.choice((1, 0.5))
    sent: list[int] = []
    got: list[int] = []
    resets: list[tuple[int, int]] = []  # pixels sent and received before

    async def write(ctx: SimulatorContext) -> None:
        await ctx.delay(period * random.random())
        offered = False
        while True:
            if not offered and random.random() < i_rate:
                offered = True
                ctx.set(queue.i.payload.pixel, len(sent) % (1 << BITS))
            ctx.set(queue.i.valid, offered)
            await ctx.delay(period * random.uniform(0.3, 0.5))
            if offered and ctx.get(queue.i.ready):
                sent.append(len(sent))
                offered = False
            ctx.set(queue.clk, 1)
            await ctx.delay(period * random.uniform(0.3, 0.5))
            ctx.set(queue.clk, 0)

    async def read(ctx: SimulatorContext) -> None:
        for _ in range(20 * pixels):
            if len(got) == pixels:
                return
            if reset and not resets and len(got) > pixels // 3:
                resets.append((len(sent), len(got)))
                ctx.set(domain.rst, 1)
                ctx.set(queue.o.ready, 0)
                for _ in range(random.randrange(1, 5)):
                    await ctx.tick()
                resets[0] = (len(sent), len(got))
                ctx.set(domain.rst, 0)
            ready = random.random() < o_rate
            ctx.set(queue.o.ready, ready)
            _, _, valid, payload = await ctx.tick().sample(queue.o.valid, queue.o.payload)
            if valid and ready:
                got.append(payload.pixel)

    simulator = Simulator(top)
    simulator.add_clock(PERIOD, phase=PERIOD * random.random())
    simulator.add_testbench(write, background=True)
    simulator.add_testbench(read)
    simulator.run()
    assert len(got) == pixels
    if not reset:
        assert got == sent[:pixels]
    else:
        first, before = resets[0]
        assert got[:before] == sent[:before]
        assert got[before:] == sent[first : first + pixels - before]


@pytest.mark.parametrize("seed", range(8))
def test_two_clocks(seed: int) -> None:
    carried(seed, reset=seed % 2 == 1)


def test_as_many_wait_as_was_asked_for() -> None:
    """Of the reader's clock; and it says when no more do."""
    queue = ViewQueue(BITS, DEPTH)

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        taken = 0
        ctx.set(queue.i.valid, 1)
        for _ in range(3 * DEPTH):
            _, _, ready, full = await ctx.tick().sample(queue.i.ready, queue.full)
            assert not full or not ready
            taken += ready
        assert ctx.get(queue.full)
        assert taken == DEPTH + 2
        ctx.set(rst, 1)
        assert not ctx.get(queue.i.ready)

    simulate(queue, bench)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('w_domain="source"', 'w_domain="sync"'),
        ("fifo.w_rdy & ~resets", "fifo.w_rdy"),
        ("fifo.r_en.eq(behind.i.ready)", "fifo.r_en.eq(1)"),
    ],
)
def test_a_broken_one_is_found_out(old: str, new: str) -> None:
    block = mutated(ViewQueue, old, new)

    def check(seed: int) -> bool:
        try:
            carried(seed, reset=seed % 2 == 1, block=block)
        except AssertionError:
            return False
        return True

    assert not all(map(check, range(8)))
