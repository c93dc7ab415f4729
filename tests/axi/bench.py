"""The bench of the AXI core: sources, sinks and masters are cocotbext-axi's. `tests.axi.runs` starts it.

What is to be sent is a list of steps: lines of video, and writes to registers between them.
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
PERIOD = 10
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
    source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis"), dut.aclk, dut.aresetn, False)
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis"), dut.aclk, dut.aresetn, False)
    master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axil"), dut.aclk, dut.aresetn, False)
    for each in (source, sink):
        each.log.setLevel("WARNING")
    for each in (master.write_if, master.read_if):
        each.log.setLevel("WARNING")
    dut.aresetn.value = 0
    await ClockCycles(dut.aclk, 4)
    dut.aresetn.value = 1
    await RisingEdge(dut.aclk)
    source.set_pause_generator(pauses(Random(job["seed"] + 1), job["idle"]))
    sink.set_pause_generator(pauses(Random(job["seed"] + 2), job["pressure"]))

    lanes = len(dut.s_axis_tdata) // 8
    reads: dict[str, int] = {}

    async def chatter() -> None:
        """Reads of any register at any time."""
        while True:
            await ClockCycles(dut.aclk, random.randrange(1, 40))
            address = random.randrange(0, 1 << len(dut.s_axil_araddr), 4)
            await master.read(address, 4)

    talk = cocotb.start_soon(chatter())
    for step in job["steps"]:
        if "write" in step:
            address, value = step["write"]
            await master.write(address, value.to_bytes(4, "little"))
        elif "wait" in step:
            await source.wait()
        else:
            data = bytes.fromhex(step["line"])
            user = [int(k // lanes in step["sof"]) for k in range(len(data))]
            await source.send(AxiStreamFrame(data, tuser=user))
            await source.wait()
    lines = []
    while True:
        got = await First(cocotb.start_soon(sink.recv()), Timer(QUIET * PERIOD, "ns"))
        if not isinstance(got, AxiStreamFrame):
            break
        user = got.tuser if isinstance(got.tuser, list) else [got.tuser] * len(got.tdata)
        lines.append({"data": bytes(got.tdata).hex(), "sof": [k for k, bit in enumerate(user) if bit]})
    talk.cancel()
    irq = int(dut.irq.value)
    for name, address in job["registers"].items():
        reads[name] = int.from_bytes((await master.read(address, 4)).data, "little")
    path.with_suffix(".out").write_text(json.dumps({"lines": lines, "registers": reads, "irq": irq}))
