"""What the host and the simulator's bench tell each other: a job, and the record of its run."""

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from softdepth.sim.stalls import Pauses, Stalls

JOB_VARIABLE = "SOFTDEPTH_SIM_JOB"
"""Environment variable that holds the path of the bench's job."""

PROGRESS_SUFFIX = ".progress"
RECORD_SUFFIX = ".record.npz"
PART_SUFFIX = ".part{}.npz"
"""Of the results between two of a job's cuts, numbered from 0, and the seconds that they took."""


class Violation(NamedTuple):
    """A stream rule that the core broke, and the clock at which it shows."""

    cycle: int
    rule: str


@dataclass(frozen=True)
class Job:
    """A run of the bench.

    Members
    -------
    transfers : input payloads, uint64 or, where they are longer, Python integers.
    stalls : of the source and the sink.
    resets : the core is reset when this many transfers have been taken.
    gaps : idle clocks of the source, by the number of transfers taken before them.
    cuts : ascending numbers of results. At each, the results since the last cut are handed over at once,
        while the run goes on; they are not in its record.
    expected : results since the last reset after which the run is complete, or None: run until quiet.
    settle : clocks that a complete run goes on, to catch surplus results.
    patience : after this many clocks without a transfer, although both sides are willing, the run stops.
    """

    transfers: NDArray[Any]
    stalls: Stalls = field(default_factory=Stalls)
    resets: tuple[int, ...] = ()
    gaps: Mapping[int, int] = field(default_factory=dict)
    cuts: tuple[int, ...] = ()
    expected: int | None = None
    settle: int = 500
    patience: int = 20_000

    def save(self, path: Path) -> None:
        """Write to an npz file."""
        plain = {
            "stalls": asdict(self.stalls),
            "resets": self.resets,
            "gaps": list(self.gaps.items()),
            "cuts": self.cuts,
            "expected": self.expected,
            "settle": self.settle,
            "patience": self.patience,
        }
        long = self.transfers.dtype == object
        np.savez(
            path,
            transfers=self.transfers.astype(str) if long else self.transfers,
            plain=np.array(json.dumps(plain)),
        )

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read what `save` wrote."""
        with np.load(path) as file:
            plain = json.loads(str(file["plain"]))
            transfers = file["transfers"]
        if transfers.dtype.kind == "U":
            transfers = np.array([int(word) for word in transfers], object)
        stalls = Stalls(**{side: Pauses(**pauses) for side, pauses in plain.pop("stalls").items()})
        resets, gaps = tuple(plain.pop("resets")), dict(plain.pop("gaps"))
        return cls(transfers, stalls, resets, gaps, tuple(plain.pop("cuts")), **plain)


@dataclass(frozen=True)
class Record:
    """What happened in a run; cycles are counted in clocks from the bench's start.

    Members
    -------
    payloads : the packed value of each result; after the job's last cut, where it has cuts.
    cycles : of each result, the clock that took it.
    epochs : of each result, how many of the job's resets came before it.
    taken : the clock at which the core took each transfer.
    status : the packed status port at the end.
    violations : broken stream rules, the first hundred.
    clocks : length of the run.
    complete : whether the expected results came; False when patience ran out.
    """

    payloads: NDArray[np.uint64]
    cycles: NDArray[np.int64]
    epochs: NDArray[np.int64]
    taken: NDArray[np.int64]
    status: int
    violations: tuple[Violation, ...]
    clocks: int
    complete: bool

    def save(self, path: Path) -> None:
        """Write to an npz file, which appears whole or not at all."""
        plain = {
            "status": self.status,
            "violations": self.violations,
            "clocks": self.clocks,
            "complete": self.complete,
        }
        part = path.with_suffix(".part")
        with part.open("wb") as file:
            np.savez(
                file,
                payloads=self.payloads,
                cycles=self.cycles,
                epochs=self.epochs,
                taken=self.taken,
                plain=np.array(json.dumps(plain)),
            )
        os.replace(part, path)

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read what `save` wrote."""
        with np.load(path) as file:
            plain = json.loads(str(file["plain"]))
            plain["violations"] = tuple(Violation(*pair) for pair in plain["violations"])
            return cls(**{name: file[name] for name in ("payloads", "cycles", "epochs", "taken")}, **plain)
