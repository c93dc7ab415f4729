"""The bench of the LiteX SoC: a host on its bus, and the streams, all cocotbext-axi's."""

import json
import os
from pathlib import Path
from typing import Any

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles
from cocotbext.axi import (
    AxiLiteBus,
    AxiLiteMaster,
    AxiStreamBus,
    AxiStreamFrame,
    AxiStreamSink,
    AxiStreamSource,
)

JOB_VARIABLE = "SOFTDEPTH_LITEX_JOB"
BYTE = 8


@cocotb.test(timeout_time=1, timeout_unit="ms")
async def run(dut: Any) -> None:
    """Writes and lines as the job says; afterwards, what was read and what came out."""
    path = Path(os.environ[JOB_VARIABLE])
    job = json.loads(path.read_text())
    cocotb.start_soon(Clock(dut.clock, 10, unit="ns").start())
    source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis"), dut.clock, dut.reset)
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis"), dut.clock, dut.reset)
    host = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "host"), dut.clock, dut.reset)
    for each in (source, sink, host.write_if, host.read_if):
        each.log.setLevel("WARNING")

    async def read(address: int) -> int:
        return int.from_bytes((await host.read(address, 4)).data, "little")

    dut.reset.value = 1
    await ClockCycles(dut.clock, 4)
    dut.reset.value = 0
    await ClockCycles(dut.clock, 2)
    found: dict[str, Any] = {"before": [await read(address) for address in job["before"]]}
    for address, value in job["writes"]:
        await host.write(address, value.to_bytes(4, "little"))
    lanes = len(dut.s_axis_tdata) // BYTE
    for line in job["lines"]:
        data = bytes.fromhex(line["data"])
        user = [int(line["sof"] and k < lanes) for k in range(len(data))]
        await source.send(AxiStreamFrame(data, tuser=user))
    found["lines"] = []
    for _ in job["lines"]:
        got = await sink.recv()
        user = got.tuser if isinstance(got.tuser, list) else [got.tuser]
        found["lines"].append({"data": bytes(got.tdata).hex(), "sof": bool(user[0])})
    await ClockCycles(dut.clock, 100)
    found["interrupt"] = [int(dut.irq.value)]
    found["after"] = [await read(address) for address in job["after"]]
    await host.write(job["clear"], (1).to_bytes(4, "little"))
    await ClockCycles(dut.clock, 4)
    found["interrupt"].append(int(dut.irq.value))
    path.with_suffix(".out").write_text(json.dumps(found))
