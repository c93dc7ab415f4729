"""The bench of the AXI core: sources, sinks and masters are cocotbext-axi's. `tests.axi.runs` starts it.

What is to be sent is a list of steps: lines of video, and writes to registers between them. Two streams have
theirs each, which go out side by side after the others. Before that, the core may be reset any number of
times, each while it takes in other lines and writes.
"""

import json
import os
from itertools import count
from pathlib import Path
from random import Random
from typing import Any

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, First, RisingEdge, Timer
from cocotbext.axi import (
    AxiLiteBus,
    AxiLiteMaster,
    AxiStreamBus,
    AxiStreamFrame,
    AxiStreamSink,
    AxiStreamSource,
)

JOB_VARIABLE = "SOFTDEPTH_AXI_JOB"
PERIOD = 100
"""Nanoseconds."""
OWN_PERIODS = (60, 160)
"""Nanoseconds of a view's own clock, at least and less than."""
QUIET = 6000
"""Clocks without a line after which nothing more is expected."""
TIMEOUT = 40_000_000


def pauses(random: Random, share: float):
    """Idle or back-pressure, clock by clock."""
    for _ in count():
        yield random.random() < share


@cocotb.test()
async def run(dut: Any) -> None:
    """Runs the job that the environment names, and writes beside it what came out."""
    path = Path(os.environ[JOB_VARIABLE])
    job = json.loads(path.read_text())
    random = Random(job["seed"])
    cocotb.start_soon(Clock(dut.aclk, PERIOD, unit="ns").start())
    sources: dict[str, AxiStreamSource] = {}
    for number, view in enumerate(job["views"]):
        prefix = f"s_axis_{view}".removesuffix("_")
        clock = getattr(dut, f"{prefix}_aclk", dut.aclk)
        if clock is not dut.aclk:
            cocotb.start_soon(Clock(clock, random.randrange(*OWN_PERIODS, 2), unit="ns").start())
        bus = AxiStreamBus.from_prefix(dut, prefix)
        sources[view] = AxiStreamSource(bus, clock, dut.aresetn, False)
        sources[view].set_pause_generator(pauses(Random(job["seed"] + 3 + number), job["idle"]))
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis"), dut.aclk, dut.aresetn, False)
    master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axil"), dut.aclk, dut.aresetn, False)
    for each in (*sources.values(), sink):
        each.log.setLevel("WARNING")
    for each in (master.write_if, master.read_if):
        each.log.setLevel("WARNING")
    dut.aresetn.value = 0
    await ClockCycles(dut.aclk, 4)
    dut.aresetn.value = 1
    await RisingEdge(dut.aclk)
    sink.set_pause_generator(pauses(Random(job["seed"] + 2), job["pressure"]))

    async def chatter() -> None:
        """Reads of any register at any time."""
        while True:
            await ClockCycles(dut.aclk, random.randrange(1, 40))
            address = random.randrange(0, 1 << len(dut.s_axil_araddr), 4)
            await master.read(address, 4)

    talk = cocotb.start_soon(chatter())

    def frame_of(view: str, step: dict[str, Any]) -> AxiStreamFrame:
        data = bytes.fromhex(step["line"])
        user = [int(k // sources[view].byte_lanes in step["sof"]) for k in range(len(data))]
        return AxiStreamFrame(data, tuser=user)

    async def registers() -> dict[str, int]:
        found = {}
        for name, address in job["registers"].items():
            found[name] = int.from_bytes((await master.read(address, 4)).data, "little")
        return found

    after_resets = []
    for clocks in job["resets"]:
        for view, steps in job["cut"].items():
            for step in steps:
                if "write" in step:
                    address, value = step["write"]
                    cocotb.start_soon(master.write(address, value.to_bytes(4, "little")))
                else:
                    sources[view].send_nowait(frame_of(view, step))
        await ClockCycles(dut.aclk, clocks)
        dut.aresetn.value = 0
        await ClockCycles(dut.aclk, random.randrange(1, 4))
        for each in (*sources.values(), sink):
            each.clear()
        dut.aresetn.value = 1
        await RisingEdge(dut.aclk)
        after_resets.append(await registers())

    async def act(view: str) -> None:
        source = sources[view]
        for step in job["views"][view]:
            if "write" in step:
                address, value = step["write"]
                await master.write(address, value.to_bytes(4, "little"))
                continue
            await source.send(frame_of(view, step))
            await source.wait()

    acting = [cocotb.start_soon(act(view)) for view in sources]
    if len(acting) == 1:
        await acting[0]
    # Of two streams one may be left with pixels that have no partner.
    lines = []
    while True:
        got = await First(cocotb.start_soon(sink.recv()), Timer(QUIET * PERIOD, "ns"))
        if not isinstance(got, AxiStreamFrame):
            break
        user = got.tuser if isinstance(got.tuser, list) else [got.tuser] * len(got.tdata)
        lines.append({"data": bytes(got.tdata).hex(), "sof": [k for k, bit in enumerate(user) if bit]})
    for task in (talk, *acting):
        task.cancel()
    irq = int(dut.irq.value)
    out = {"lines": lines, "registers": await registers(), "irq": irq, "after_resets": after_resets}
    path.with_suffix(".out").write_text(json.dumps(out))
