"""Run transfers through a simulated design and collect what comes out."""

import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from cocotb_tools.runner import get_runner
from numpy.typing import NDArray

from softdepth.files import move_in
from softdepth.sim.build import TOP, build
from softdepth.sim.job import JOB_VARIABLE, PART_SUFFIX, PROGRESS_SUFFIX, RECORD_SUFFIX, Job, Record
from softdepth.spec.errors import ToolError

Progress = Callable[[int], None]
"""Called now and then, from another thread, with the number of results so far."""

Parts = Callable[[int, NDArray[np.uint64], float], None]
"""Called from another thread at each of the job's cuts, in turn: number, payloads up to it, their seconds."""

POLL_SECONDS = 0.2


@dataclass(frozen=True)
class StreamResult(Record):
    """A `Record`, with the wall-clock seconds of the build and of the run.

    Members
    -------
    seconds_build : zero or nearly, where `cached`.
    seconds_sim : of the simulation, with the start of Python inside it.
    """

    seconds_build: float
    seconds_sim: float
    cached: bool


def run_stream(
    verilog: str,
    job: Job,
    *,
    progress: Progress | None = None,
    parts: Parts | None = None,
    waves: Path | None = None,
) -> StreamResult:
    """Build `verilog` (or take it from the cache) and run `job`.

    `waves` names a VCD file to write. An error raised by `parts` is raised again after the run. Raises
    `ToolError` for a missing tool, a failed build or a simulator that stops without a record. A run that is
    not complete, or that broke a stream rule, is a result like any other: see `Record`.
    """
    program = build(verilog, waves=waves is not None)
    folder = Path(tempfile.mkdtemp(prefix="softdepth-sim-"))
    path = folder / "job.npz"
    log = folder / "log"
    try:
        job.save(path)
        start = time.monotonic()
        with _reports(path, progress, parts):
            ended = simulate(
                program.folder, "softdepth.sim.bench", folder, {JOB_VARIABLE: str(path)}, waves is not None
            )
        seconds = time.monotonic() - start
        if not ended or not path.with_suffix(RECORD_SUFFIX).exists():
            raise ToolError(f"the simulator stopped: {_reason(log)}", f"see {log}")
        record = Record.load(path.with_suffix(RECORD_SUFFIX))
        if waves is not None:
            move_in(folder / "dump.vcd", waves)
    except ToolError:
        raise  # its log is left for the user to read
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    shutil.rmtree(folder, ignore_errors=True)
    return StreamResult(
        **vars(record), seconds_build=program.seconds, seconds_sim=seconds, cached=program.cached
    )


def simulate(
    program: Path, bench: str, folder: Path, environment: Mapping[str, str], waves: bool = False
) -> bool:
    """Run the cocotb tests of the module `bench` in a program of `softdepth.sim.build`.

    `folder` takes the log and all else that the run leaves; `environment` is added to the bench's own.
    Returns whether the simulator ended well; the tests themselves write down what they found.
    """
    runner = get_runner("verilator")
    runner.log.disabled = True  # what it says on the terminal is in the log too
    try:
        runner.test(
            test_module=bench,
            hdl_toplevel=TOP,
            hdl_toplevel_lang="verilog",
            build_dir=program,
            test_dir=folder,
            results_xml=str(folder / "results.xml"),
            log_file=folder / "log",
            waves=waves,
            extra_env=dict(environment),
        )
    except (RuntimeError, SystemExit):  # how cocotb's runner says so
        return False
    return True


@contextmanager
def _reports(job: Path, progress: Progress | None, parts: Parts | None) -> Iterator[None]:
    """Pass the bench's progress and parts on for as long as the body runs; the last parts after it."""
    if progress is None and parts is None:
        yield
        return
    ended = threading.Event()
    handed = 0
    failures: list[Exception] = []

    def pass_on() -> None:
        nonlocal handed
        while parts and not failures and (file := job.with_suffix(PART_SUFFIX.format(handed))).exists():
            try:
                with np.load(file) as part:
                    parts(handed, part["payloads"], float(part["seconds"]))
            except Exception as error:  # raised again where the run ends
                failures.append(error)
            file.unlink()
            handed += 1

    def watch() -> None:
        while not ended.wait(POLL_SECONDS):
            pass_on()
            try:
                done = int(job.with_suffix(PROGRESS_SUFFIX).read_text())
            except (OSError, ValueError):
                continue  # not there yet, or half written
            if progress:
                progress(done)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        ended.set()
        watcher.join()
    pass_on()
    if failures:
        raise failures[0]


def _reason(log: Path) -> str:
    """The last line that names an error, or else the last line."""
    lines = log.read_text(errors="replace").split("\n") if log.exists() else []
    lines = [line.strip() for line in lines if line.strip()] or ["it left no log"]
    return next((line for line in reversed(lines) if "Error: " in line), lines[-1])
