"""The cocotb test that drives a core inside the simulator; `softdepth.sim.stream` starts it.

One coroutine does everything at each rising clock edge, because in a simulation of this size most
of the time goes into waking Python up. At the edge it sees the values that the core's registers
see; what it writes takes effect after the edge.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cocotb
import numpy as np
from cocotb.clock import Clock

from softdepth.sim.job import JOB_VARIABLE, PROGRESS_SUFFIX, RECORD_SUFFIX, Job, Record, Violation

CLOCK_STEPS = 2
RESET_CLOCKS = 4
REPORT_CLOCKS = 8192
MOST_VIOLATIONS = 100


@cocotb.test()
async def run_job(dut: Any) -> None:
    """Run the job named by the environment and write its record beside it."""
    path = Path(os.environ[JOB_VARIABLE])
    job = Job.load(path)
    Clock(dut.clk, CLOCK_STEPS, unit="step").start(start_high=False)
    bench = Bench(dut, job, path.with_suffix(PROGRESS_SUFFIX))
    await bench.run()
    bench.record().save(path.with_suffix(RECORD_SUFFIX))


class Bench:
    """Source, sink and rule checker of one run."""

    def __init__(self, dut: Any, job: Job, progress: Path) -> None:
        self.dut = dut
        self.job = job
        self.progress = progress
        self.cycle = 0
        self.epoch = 0
        self.complete = False
        self.taken: list[int] = []
        self.payloads: list[str] = []  # binary digits, as the simulator gives them
        self.cycles: list[int] = []
        self.epochs: list[int] = []
        self.violations: list[Violation] = []

    def record(self) -> Record:
        """The run so far."""
        return Record(
            payloads=np.array([int(text, 2) for text in self.payloads], np.uint64),
            cycles=np.array(self.cycles, np.int64),
            epochs=np.array(self.epochs, np.int64),
            taken=np.array(self.taken, np.int64),
            status=int(self.dut.status.value),
            violations=tuple(self.violations),
            clocks=self.cycle,
            complete=self.complete,
        )

    async def run(self) -> None:
        """Reset, then clock until the run is complete and has settled, or patience runs out."""
        dut, job = self.dut, self.job
        edge = dut.clk.rising_edge
        i_valid, i_ready, i_payload = dut.i__valid, dut.i__ready, dut.i__payload
        o_valid, o_ready, o_payload = dut.o__valid, dut.o__ready, dut.o__payload
        transfers: list[int] = job.transfers.tolist()
        source_pauses = _pauses(job.stalls.input.clocks(), job.stalls.input.mode, job.stalls.input.initial)
        sink_pauses = _pauses(job.stalls.output.clocks(), job.stalls.output.mode, job.stalls.output.initial)
        resets = sorted(job.resets, reverse=True)
        gaps = dict(job.gaps)

        index = 0  # of the transfer on offer, or the next to be
        gap = 0
        offered = accepting = False
        held: str | None = None  # a result that waits to be taken
        idle = settled = 0
        first_of_epoch = 0
        await self._reset()

        while True:
            await edge
            self.cycle += 1
            idle += accepting and (offered or index == len(transfers))

            if offered and i_ready.value:
                self.taken.append(self.cycle)
                index += 1
                offered = False
                idle = 0
            if o_valid.value:
                payload = str(o_payload.value)
                if held is not None and payload != held:
                    self._violated("o.payload changed while o.valid waited for o.ready")
                if accepting:
                    self.payloads.append(payload)
                    self.cycles.append(self.cycle)
                    self.epochs.append(self.epoch)
                    held = None
                    idle = 0
                else:
                    held = payload
            elif held is not None:
                self._violated("o.valid fell before o.ready took the result")
                held = None

            if self.cycle % REPORT_CLOCKS == 0:
                self.progress.write_text(f"{len(self.payloads)}\n")
            if idle >= job.patience:
                self.complete = job.expected is None
                return
            if job.expected is not None and index == len(transfers) and not resets:
                if len(self.payloads) - first_of_epoch >= job.expected:
                    settled += 1
                    if settled > job.settle:
                        self.complete = True
                        return

            if not offered:
                if resets and resets[-1] <= index:
                    resets.pop()
                    await self._reset()
                    self.epoch += 1
                    first_of_epoch = len(self.payloads)
                    accepting, held = False, None
                elif index < len(transfers):
                    gap += gaps.pop(index, 0)
                    if gap:
                        gap -= 1
                    elif source_pauses is None or not next(source_pauses):
                        i_payload.value = transfers[index]
                        offered = True
                i_valid.value = offered
            ready = sink_pauses is None or not next(sink_pauses)
            if ready != accepting:
                accepting = ready
                o_ready.value = ready

    async def _reset(self) -> None:
        """Both sides are silent in a reset, so that nothing is taken at its edges."""
        dut = self.dut
        dut.rst.value = 1
        dut.i__valid.value = 0
        dut.o__ready.value = 0
        for _ in range(RESET_CLOCKS):
            await dut.clk.rising_edge
        self.cycle += RESET_CLOCKS
        dut.rst.value = 0

    def _violated(self, rule: str) -> None:
        if len(self.violations) < MOST_VIOLATIONS:
            self.violations.append(Violation(self.cycle, rule))


def _pauses(clocks: Iterator[bool], mode: str, initial: int) -> Iterator[bool] | None:
    """None where there are none: asking each clock would cost time."""
    return None if mode == "none" and not initial else clocks
