"""The whole core with its registers on Wishbone, in Amaranth's simulator: identity, settings, frames."""

from collections.abc import Iterator
from importlib.metadata import version
from itertools import chain

import numpy as np
import pytest
from amaranth.sim import Simulator, SimulatorContext

from softdepth.golden.front.pair import Image
from softdepth.hdl.axi.core import AxiCore
from softdepth.spec.axi_options import AxiOptions
from tests.axi.runs import ADDRESSES, ORDER, SMALL, expected
from tests.cocotb.scenes import textured
from tests.support.mutations import mutated

CONFIG = SMALL.override(["max_width=16", "max_height=8"])
HALF = 1e-6
ALL = 0b1111
WAIT = 4_000
"""Clocks in which anything that is due has come."""


def words(left: Image, right: Image) -> list[int]:
    """``s_axis_tdata`` of a frame's pixels."""
    both = np.concatenate([left[..., ORDER], right[..., ORDER]], axis=-1)
    return [int.from_bytes(pixel.tobytes(), "little") for row in both for pixel in row]


class Driver:
    """Clocks, the source, the sink, and a Wishbone master that waits for ``ack``.

    Members
    -------
    results : words that have left.
    """

    def __init__(self, ctx: SimulatorContext, dut: AxiCore) -> None:
        self.ctx, self.dut = ctx, dut
        self.results: list[int] = []
        self._pixels: Iterator[tuple[int, bool, bool]] = iter(())
        self._shown = False

    def send(self, left: Image, right: Image) -> None:
        """A frame, after those before it, as fast as it is taken."""
        width = left.shape[1]
        frame = ((word, k == 0, k % width == width - 1) for k, word in enumerate(words(left, right)))
        self._pixels = chain(self._pixels, frame)

    async def clock(self) -> None:
        ctx, dut = self.ctx, self.dut
        if not self._shown and (pixel := next(self._pixels, None)):
            self._shown = True
            for name, value in zip(("tdata", "tuser", "tlast"), pixel, strict=True):
                ctx.set(getattr(dut, f"s_axis_{name}"), value)
        ctx.set(dut.s_axis_tvalid, self._shown)
        await ctx.delay(HALF)
        taken = self._shown and ctx.get(dut.s_axis_tready)
        if ctx.get(dut.m_axis_tvalid):
            self.results.append(ctx.get(dut.m_axis_tdata))
        ctx.set(dut.aclk, 1)
        await ctx.delay(HALF)
        ctx.set(dut.aclk, 0)
        self._shown = self._shown and not taken

    async def access(self, address: int, *, write: int | None = None, lanes: int = ALL) -> int:
        """A word is read, or its `lanes` are written; answered after one clock, and once."""
        ctx, dut = self.ctx, self.dut
        for name, value in (
            ("we", write is not None),
            ("adr", address // 4),
            ("sel", lanes),
            ("dat_w", write or 0),
            ("cyc", 1),
            ("stb", 1),
        ):
            ctx.set(getattr(dut, f"wb_{name}"), value)
        assert not ctx.get(dut.wb_ack)
        await self.clock()
        assert ctx.get(dut.wb_ack)
        found = ctx.get(dut.wb_dat_r)
        await self.clock()
        ctx.set(dut.wb_cyc, 0)
        ctx.set(dut.wb_stb, 0)
        assert not ctx.get(dut.wb_ack)
        return found

    async def read(self, name: str) -> int:
        return await self.access(ADDRESSES[name])

    async def write(self, name: str, value: int, lanes: int = ALL) -> None:
        await self.access(ADDRESSES[name], write=value, lanes=lanes)

    async def until(self, results: int) -> None:
        for _ in range(WAIT):
            if len(self.results) >= results:
                return
            await self.clock()
        pytest.fail(f"{len(self.results)} results, not {results}")


async def scenario(drive: Driver) -> None:
    read, write = drive.read, drive.write
    assert (await read("IDENTITY")).to_bytes(4, "big") == b"SDPT"
    number = await read("VERSION")
    assert f"{number >> 16}.{number >> 8 & 0xFF}.{number & 0xFF}" == version("softdepth")
    assert f"{await read('CONFIG_HIGH'):04x}{await read('CONFIG_LOW'):08x}" == CONFIG.hash
    assert await read("LIMITS") == CONFIG.max_height << 16 | CONFIG.max_width
    await write("IDENTITY", 0)
    assert (await read("IDENTITY")).to_bytes(4, "big") == b"SDPT"

    assert await read("CHECK") == CONFIG.post.tolerance
    height, width = 4, 12
    await write("GEOMETRY", 0xFF00 | width, 0b0001)
    assert await read("GEOMETRY") == width
    await write("GEOMETRY", height << 16, 0b1100)
    assert await read("GEOMETRY") == height << 16 | width
    await write("CONFIDENCE", 0xFFFFFF_3C)
    assert await read("CONFIDENCE") == 0x3C

    first, second = textured(height, width, 1), textured(height, width, 4)
    drive.send(*first)
    await drive.until(1)
    assert await read("STATUS") == 0b01
    await write("INVALID", 0x7FF)
    await write("CHECK", 2)
    await write("CONFIDENCE", 0)
    assert await read("STATUS") == 0b11
    drive.send(*second)
    size = height * width
    await drive.until(2 * size)
    got = np.array(drive.results, dtype=np.uint32).reshape(2, height, width)
    assert np.array_equal(got[0], expected(*first, CONFIG, floor=0x3C, pixels=False)), "the first frame"
    lax = CONFIG.override(["post.tolerance=2"])
    later = expected(*second, lax, invalid=0x7FF, pixels=False)
    assert np.array_equal(got[1], later), "the second frame"
    # Each of the three settings is seen in the results.
    for config, floor, invalid in ((CONFIG, 0, 0x7FF), (lax, 0x3C, 0x7FF), (lax, 0, 0)):
        other = expected(*second, config, floor=floor, invalid=invalid, pixels=False)
        assert not np.array_equal(later, other)

    assert await read("FRAMES") == 2
    assert await read("SEEN") == height << 16 | width
    assert not drive.ctx.get(drive.dut.irq)
    await write("INTERRUPTS", 1)
    assert drive.ctx.get(drive.dut.irq)
    await write("FLAGS", 1, 0b1110)
    assert await read("FLAGS") == 1
    await write("FLAGS", 1)
    assert await read("FLAGS") == 0
    assert not drive.ctx.get(drive.dut.irq)


def simulate(core: type[AxiCore]) -> None:
    dut = core(CONFIG, AxiOptions(bus="wishbone"))

    async def bench(ctx: SimulatorContext) -> None:
        drive = Driver(ctx, dut)
        ctx.set(dut.m_axis_tready, 1)
        await drive.clock()
        ctx.set(dut.aresetn, 1)
        await scenario(drive)

    simulator = Simulator(dut)
    simulator.add_testbench(bench)
    simulator.run()


def test_registers_and_frames_over_wishbone() -> None:
    simulate(AxiCore)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("m.d.sync += [pending.eq(0), *(applied", "m.d.sync += [*(applied", "results, not"),
        ("m.Elif(pending & ~frames.busy)", "m.Elif(pending)", "the first frame"),
        ("self._core.settings.hold.eq(pending)", "self._core.settings.hold.eq(0)", "the second frame"),
    ],
)
def test_settings_taken_over_wrongly_are_found_out(old: str, new: str, said: str) -> None:
    """Over and over; in mid-frame; while the next frame's pixels go in."""
    with pytest.raises((AssertionError, pytest.fail.Exception), match=said):
        simulate(mutated(AxiCore, old, new))
