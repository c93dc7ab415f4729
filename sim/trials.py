"""Short runs of a core from reset, thousands of clocks in a millisecond: its bench is C++, not Python.

For regressions of many designs that differ a little, such as one netlist with faults to choose from.
`softdepth.sim.frames` is for pictures.
"""

import os
import re
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import NamedTuple

from softdepth.sim.build import TOP, Bench, build
from softdepth.spec.errors import ToolError

FAULTS = "mutant"
"""The input that selects a fault, where a design has it."""

COVERAGE_VARIABLE = "SOFTDEPTH_COVERAGE"
"""Names the bench's file of coverage."""

LONGEST = 64
"""Bits of a payload that the bench can drive."""

WAITS = 1025
"""Of a sink: not ready before there is an offer."""


class Due(NamedTuple):
    """The packed result that is expected, and which of its bits count."""

    bits: int
    mask: int


@dataclass(frozen=True)
class Trial:
    """A run that begins with a reset.

    While the source has nothing to offer it shows noise.

    Members
    -------
    sent : packed inputs.
        due : the expected results, in order; with ``exact``, and no others.
        status : the packed counters at the end; None if they are not checked.
    i_pause, o_pause : shares of the clocks in which nothing is offered, and nothing taken, in 1024ths.
        With `WAITS` the sink takes what has been on offer for a clock, and nothing sooner.
    seed : of pauses and noise.
    reset : clocks of the reset. Meanwhile noise is on offer, and must not be taken.
    cut : clocks after which it ends, complete or not; with 0, it runs to its end.
    limit : the clock by which the last result must have come; with 0, any clock.
    patience : clocks without a transfer after which an incomplete run has stopped for good.
    settle : clocks that a complete one goes on without a transfer, to catch surplus results.
    """

    sent: Sequence[int]
    due: Sequence[Due]
    status: int | None = None
    exact: bool = True
    i_pause: int = 0
    o_pause: int = 0
    seed: int = 0
    reset: int = 1
    cut: int = 0
    limit: int = 0
    patience: int = 2000
    settle: int = 200

    def text(self) -> str:
        """What the bench reads."""
        numbers = [
            *(self.seed, self.i_pause, self.o_pause, self.reset, self.cut, self.patience, self.settle),
            *(int(self.exact), self.limit, self.status or 0, int(self.status is not None)),
            *(len(self.sent), len(self.due), *self.sent, *(n for each in self.due for n in each)),
        ]
        return " ".join(map(str, numbers))


class Verdict(NamedTuple):
    """Of one design: the trial that it failed or None, what was wrong there, and the clocks that it ran."""

    trial: int | None
    wrong: str
    clocks: int


class Coverage(NamedTuple):
    """What Verilator shall count, ``line`` or ``toggle``, and the file for its counts."""

    kind: str
    file: Path


def run_trials(
    verilog: str,
    trials: Sequence[Trial],
    faults: Sequence[int] = (),
    *,
    coverage: Coverage | None = None,
) -> list[Verdict]:
    """Run all trials one after the other on one simulated core, up to the first that fails.

    With `faults`, once for each value of the design's input `FAULTS`: a verdict each, in that order.
    Registers and memories without a reset begin with random bits. With `coverage`, what was reached is
    counted, too. Raises `ToolError` for a failed build or a bench that stops.
    """
    bits = {name: int(top) + 1 for top, name in re.findall(r"^\s*input \[(\d+):0\] (\w+);", verilog, re.M)}
    longest = bits["i_payload"]
    if longest > LONGEST:
        raise ToolError(
            f"a payload of {longest} bits is longer than the {LONGEST} that trials drive",
            "use softdepth.sim.frames, or a smaller pixel",
        )
    defines = [f"#define I_MASK {(1 << longest) - 1}ULL", *(["#define MUTANTS"] if FAULTS in bits else [])]
    # If a fault inverts one bit by another, a word depends on itself, although its bits do not.
    flags = ["-Wno-UNOPTFLAT", "--x-initial", "unique"]
    environment = dict(os.environ)
    if coverage:
        flags.append(f"--coverage-{coverage.kind}")
        environment[COVERAGE_VARIABLE] = str(coverage.file)
    text = resources.files("softdepth.sim").joinpath("trials.cpp").read_text()
    program = build(verilog, bench=Bench("\n".join([*defines, text]), tuple(flags)))
    with tempfile.TemporaryDirectory(prefix="softdepth-trials-") as name:
        job = Path(name) / "trials"
        job.write_text("\n".join(trial.text() for trial in trials))
        done = subprocess.run(
            [str(program.folder / TOP), str(job), *map(str, faults)],
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
    lines = done.stdout.splitlines()
    if done.returncode or len(lines) != max(1, len(faults)):
        raise ToolError(
            f"the simulated trials stopped with {done.returncode}: {done.stderr.strip()[-200:]}",
            "this is a fault of the bench or of Verilator; please report it with the configuration",
        )
    verdicts = []
    for line in lines:
        _, number, clocks, wrong = line.split(" ", 3)
        verdicts.append(Verdict(int(number) - 1 if wrong else None, wrong, int(clocks)))
    return verdicts
