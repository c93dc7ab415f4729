"""The cocotb test that drives a core inside the simulator; `softdepth.sim.stream` starts it.

One coroutine does everything at each rising clock edge, because waking Python up is what takes
most of the time.
"""

import os
import time
from pathlib import Path
from typing import Any

import cocotb
import numpy as np
from cocotb.clock import Clock
from numpy.typing import NDArray

from softdepth.sim.job import JOB_VARIABLE, PART_SUFFIX, PROGRESS_SUFFIX, RECORD_SUFFIX, Job, Record
from softdepth.sim.sides import Sink, Source

CLOCK_STEPS = 2
RESET_CLOCKS = 4
REPORT_CLOCKS = 8192


@cocotb.test()
async def run_job(dut: Any) -> None:
    """Run the job named by the environment and write its record beside it."""
    path = Path(os.environ[JOB_VARIABLE])
    bench = Bench(dut, Job.load(path), path)
    Clock(dut.clk, CLOCK_STEPS, unit="step").start(start_high=False)
    await bench.run()
    bench.record().save(path.with_suffix(RECORD_SUFFIX))


class Bench:
    """A run of one job: resets, the two ends of the streams, and when to stop."""

    def __init__(self, dut: Any, job: Job, path: Path) -> None:
        self.dut = dut
        self.job = job
        self.path = path
        self.parts = 0
        self.clock = time.perf_counter()
        self.source = Source(dut, job)
        self.sink = Sink(dut, job)
        self.resets = sorted(job.resets, reverse=True)
        self.earlier_results = 0  # from before the last reset
        self.cycle = 0
        self.complete = False

    async def run(self) -> None:
        """Reset, then clock until the run is complete and has settled, or patience runs out."""
        source, sink, job = self.source, self.sink, self.job
        edge = self.dut.clk.rising_edge
        idle = settled = 0
        await self._reset()
        while True:
            await edge
            self.cycle += 1
            idle += sink.accepting and (source.offered or source.exhausted)
            taken = source.sample(self.cycle)
            if sink.sample(self.cycle):
                idle = 0
                if self.parts < len(job.cuts) and len(sink.cycles) == job.cuts[self.parts]:
                    self._hand_over()
            elif taken:
                idle = 0
            if taken or not source.offered:
                if self.resets and self.resets[-1] <= len(source.taken):
                    await self._reset()
                    self._begin_epoch()
                source.drive()
            sink.drive()

            if self.cycle % REPORT_CLOCKS == 0:
                self.path.with_suffix(PROGRESS_SUFFIX).write_text(f"{len(sink.cycles)}\n")
            settled += self._has_everything()
            if settled > job.settle or idle > job.patience:
                self.complete = settled > 0 or job.expected is None
                return

    def record(self) -> Record:
        """The run so far."""
        sink = self.sink
        return Record(
            payloads=_numbers(sink.payloads),
            cycles=np.array(sink.cycles, np.int64),
            epochs=np.array(sink.epochs, np.int64),
            taken=np.array(self.source.taken, np.int64),
            status=int(self.dut.status.value),
            violations=tuple(sink.violations),
            clocks=self.cycle,
            complete=self.complete,
        )

    def _hand_over(self) -> None:
        """Write the results since the last cut beside the job; the file appears whole."""
        target = self.path.with_suffix(PART_SUFFIX.format(self.parts))
        made = target.with_suffix(".part")
        with made.open("wb") as file:
            np.savez(file, payloads=_numbers(self.sink.hand_over()), seconds=time.perf_counter() - self.clock)
        os.replace(made, target)
        self.clock = time.perf_counter()
        self.parts += 1

    def _has_everything(self) -> bool:
        expected = self.job.expected
        if expected is None or self.resets or not self.source.exhausted:
            return False
        return len(self.sink.cycles) - self.earlier_results >= expected

    async def _reset(self) -> None:
        """Both sides are silent meanwhile, so that nothing is taken at the reset's edges."""
        self.source.silence()
        self.sink.silence()
        self.dut.rst.value = 1
        for _ in range(RESET_CLOCKS):
            await self.dut.clk.rising_edge
        self.cycle += RESET_CLOCKS
        self.dut.rst.value = 0

    def _begin_epoch(self) -> None:
        self.resets.pop()
        self.sink.epoch += 1
        self.earlier_results = len(self.sink.cycles)


def _numbers(payloads: list[str]) -> NDArray[np.uint64]:
    return np.array([int(digits, 2) for digits in payloads], np.uint64)
