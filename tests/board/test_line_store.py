"""The line store: sound lines reach the core with their markers, overtaken ones are told."""

import numpy as np
import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.boards.line_store import LineStore
from softdepth.spec.pixel import PixelFormat
from softdepth.spec.protocol import pair_bytes
from tests.support.simulation import config, simulate

PAIR_BYTES = pair_bytes(PixelFormat.RGB8)
WIDTH, HEIGHT = 5, 3


async def fill(ctx: SimulatorContext, dut: LineStore, line: bytes) -> None:
    for byte in line:
        ctx.set(dut.valid, 1)
        ctx.set(dut.data, byte)
        await ctx.tick()
    ctx.set(dut.valid, 0)


async def pulse(ctx: SimulatorContext, port: Signal) -> None:
    ctx.set(port, 1)
    await ctx.tick()
    ctx.set(port, 0)


@pytest.mark.parametrize("ready_every", [1, 3])
def test_lines_become_a_frame(ready_every):
    dut = LineStore(config(max_width=WIDTH + 3))
    frame = np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, PAIR_BYTES), dtype=np.uint8)
    taken: list[tuple[int, ...]] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        ctx.set(dut.width, WIDTH)
        ctx.set(dut.height, HEIGHT)
        for _ in range(2):  # a second frame is like the first
            await pulse(ctx, dut.begin)
            await ctx.tick()
            for line in frame:
                assert not ctx.get(dut.complete)
                await pulse(ctx, dut.close)
                await fill(ctx, dut, line.tobytes())
                assert not ctx.get(dut.overrun)
                await pulse(ctx, dut.feed)
                clock = 0
                while ctx.get(dut.busy):
                    clock += 1
                    ctx.set(dut.o.ready, clock % ready_every == 0)
                    _, _, valid, ready, pair = await ctx.tick().sample(
                        dut.o.valid, dut.o.ready, dut.o.payload
                    )
                    if valid and ready:
                        taken.append((pair.left, pair.right, pair.sof, pair.eol, pair.eof))
            await ctx.tick()
            assert ctx.get(dut.complete)

    simulate(dut, bench)
    expected = []
    for y, x in np.ndindex(HEIGHT, WIDTH):
        raw = frame[y, x].tobytes()
        left, right = int.from_bytes(raw[:3], "little"), int.from_bytes(raw[3:], "little")
        eol = x == WIDTH - 1
        expected.append((left, right, (y, x) == (0, 0), eol, eol and y == HEIGHT - 1))
    assert taken == expected * 2


@pytest.mark.parametrize(("fed", "overrun"), [(0, True), (3, False)])
def test_a_line_may_not_overtake_the_reader(fed, overrun):
    dut = LineStore(config(max_width=8))
    old, new = (np.random.default_rng(k).bytes(WIDTH * PAIR_BYTES) for k in (1, 2))
    taken = bytearray()

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        async def take() -> None:
            _, _, valid, pair = await ctx.tick().sample(dut.o.valid, dut.o.payload)
            if valid:
                taken.extend(pair.left.to_bytes(3, "little") + pair.right.to_bytes(3, "little"))

        ctx.set(dut.width, WIDTH)
        ctx.set(dut.height, HEIGHT)
        await fill(ctx, dut, old)
        await pulse(ctx, dut.close)
        await pulse(ctx, dut.feed)
        ctx.set(dut.o.ready, 1)
        while len(taken) < fed * PAIR_BYTES:
            await take()
        ctx.set(dut.o.ready, 0)
        await fill(ctx, dut, new[: 3 * PAIR_BYTES])
        assert ctx.get(dut.overrun) == overrun
        ctx.set(dut.o.ready, 1)
        while ctx.get(dut.busy):
            await take()
        await pulse(ctx, dut.close)
        assert not ctx.get(dut.overrun)

    simulate(dut, bench)
    assert bytes(taken) == old  # what enters the core is the old line in either case


def test_bytes_beyond_the_longest_line_are_left_out():
    dut = LineStore(config(max_width=8))
    line = np.random.default_rng(1).bytes(8 * PAIR_BYTES)

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        ctx.set(dut.width, 8)
        ctx.set(dut.height, 1)
        await fill(ctx, dut, line + bytes(300))
        await pulse(ctx, dut.feed)
        await ctx.tick().repeat(2)
        ctx.set(dut.o.ready, 1)
        for place in range(0, len(line), PAIR_BYTES):
            assert ctx.get(dut.o.payload.left).to_bytes(3, "little") == line[place : place + 3]
            await ctx.tick().repeat(3)
        assert not ctx.get(dut.busy)

    simulate(dut, bench)
