"""The result store: lines stay until released, the core waits, breaches are told."""

from typing import Any

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.boards.result_store import SLOTS, ResultStore
from softdepth.spec.config import CONFIDENCE_BITS, Config
from softdepth.spec.protocol import result_bytes
from tests.support.simulation import config, simulate

WIDTH = 6


class Bench:
    """The core's side and the link's side of a store."""

    def __init__(self, ctx: SimulatorContext, dut: ResultStore, size: int) -> None:
        self.ctx, self.dut, self.size = ctx, dut, size

    async def offer(self, row: int, **changes: Any) -> int:
        """Give a line, as long as it is taken at once; the number of results that were."""
        for x in range(WIDTH):
            fields = {
                "disparity": (row + x) % 4,
                "code": x % 3,
                "eol": x == WIDTH - 1,
                "sof": 0,
                "damaged": 0,
            }
            if x == WIDTH // 2:
                fields |= changes
            self.ctx.set(self.dut.i.payload, fields)
            self.ctx.set(self.dut.i.valid, 1)
            *_, ready = await self.ctx.tick().sample(self.dut.i.ready)
            self.ctx.set(self.dut.i.valid, 0)
            if not ready:
                return x
        return WIDTH

    async def pulse(self, port: Signal) -> None:
        self.ctx.set(port, 1)
        await self.ctx.tick()
        self.ctx.set(port, 0)

    async def claim(self) -> int:
        """Take the oldest line's name."""
        assert self.ctx.get(self.dut.ready)
        slot = self.ctx.get(self.dut.slot)
        await self.pulse(self.dut.claim)
        return slot

    async def read(self, slot: int) -> list[int]:
        words = []
        self.ctx.set(self.dut.read_slot, slot)
        for x in range(WIDTH):
            word = 0
            for k in range(self.size):
                self.ctx.set(self.dut.index, x * self.size + k)
                await self.ctx.tick()
                word |= self.ctx.get(self.dut.data) << 8 * k
            words.append(word)
        return words


def run(disparities: int, script: Any) -> None:
    run_core(config(max_width=WIDTH + 2, disparities=disparities, lanes=1), script)


def run_core(core: Config, script: Any) -> None:
    dut = ResultStore(core)

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        ctx.set(dut.width, WIDTH)
        await script(Bench(ctx, dut, result_bytes(core)), dut, ctx, core.result_bits)

    simulate(dut, bench)


@pytest.mark.parametrize("disparities", [8, 128])
def test_lines_stay_until_released(disparities):
    def line(row: int, bits: int) -> list[int]:
        return [(row + x) % 4 | (x % 3) << bits for x in range(WIDTH)]

    async def script(bench: Bench, dut: ResultStore, ctx: SimulatorContext, bits: int) -> None:
        for row in range(SLOTS):
            assert not ctx.get(dut.ready) or row
            assert await bench.offer(row) == WIDTH
        assert await bench.offer(99) == 0  # full: the core waits
        held = [await bench.claim() for _ in range(SLOTS)]
        assert not ctx.get(dut.ready)
        assert [await bench.read(slot) for slot in held] == [line(row, bits) for row in range(SLOTS)]
        for row in range(SLOTS, 3 * SLOTS):  # round the ring
            assert await bench.offer(99) == 0
            await bench.pulse(dut.release)
            assert await bench.offer(row) == WIDTH
            held = [*held[1:], await bench.claim()]
            first = row - SLOTS + 1
            assert [await bench.read(slot) for slot in held] == [line(first + k, bits) for k in range(SLOTS)]
        assert not ctx.get(dut.fault)

    run(disparities, script)


@pytest.mark.parametrize("changes", [{"eol": 1}, {"sof": 1}, {"damaged": 1}])
def test_a_core_that_breaks_its_rules_is_told(changes):
    async def script(bench: Bench, dut: ResultStore, ctx: SimulatorContext, bits: int) -> None:
        await bench.offer(0)
        assert not ctx.get(dut.fault)
        await bench.offer(1, **changes)
        assert ctx.get(dut.fault)
        await bench.offer(2)
        assert ctx.get(dut.fault)

    run(8, script)


def test_a_line_that_does_not_end_is_told():
    async def script(bench: Bench, dut: ResultStore, ctx: SimulatorContext, bits: int) -> None:
        ctx.set(dut.width, WIDTH - 1)
        await bench.offer(0)
        assert ctx.get(dut.fault)

    run(8, script)


def test_a_confidence_stands_above_the_code():
    core = Config.preset("robust").override([f"max_width={WIDTH + 2}", "disparities=8", "lanes=1"])
    surest = (1 << CONFIDENCE_BITS) - 1

    async def script(bench: Bench, dut: ResultStore, ctx: SimulatorContext, bits: int) -> None:
        await bench.offer(0, disparity=100, code=5, confidence=surest)
        await bench.offer(1)
        words = await bench.read(await bench.claim())
        above = core.result_bits + core.code_bits
        assert words[WIDTH // 2] == 100 | 5 << core.result_bits | surest << above
        assert [word >> above for word in words].count(0) == WIDTH - 1

    run_core(core, script)
