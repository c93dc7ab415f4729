"""Which faults the quick regression finds, and what is said of those that it does not."""

import re
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softdepth.sim.trials import run_trials
from softdepth.spec.config import Config
from tests.mutation.netlist import Mutant, mutants
from tests.mutation.regression import regression

CORES: dict[str, dict[str, Any]] = {
    "sad": {
        "cost": "sum",
        "criteria": [{"window": 5, "stored_rows": 2}],
        "disparities": 6,
        "lanes": 2,
        "max_width": 20,
        "max_height": 12,
    },
    "lite": {
        "firing": "cell",
        "rules": "corrected",
        "membership_bits": 5,
        "criteria": [{"window": 3, "dx": dx, "label_bits": 9, "stored_rows": 2} for dx in (-2, 0, 2)],
        "disparities": 6,
        "lanes": 3,
        "max_width": 24,
        "max_height": 12,
    },
    "robust": {
        "cost": "sum",
        "criteria": [
            {"kind": "census", "rows": 3, "taps": 3, "spacing": 1},
            {"kind": "gradient", "rows": 3, "columns": 3},
        ],
        "post": {
            "check": True,
            "island": 5,
            "fraction_bits": 4,
            "fill": True,
            "median": 5,
            "masked_median": 2,
            "confidence": True,
        },
        "disparities": 6,
        "lanes": 3,
        "max_width": 16,
        "max_height": 12,
    },
}
"""Small cores that between them have every room: windows, descriptors, lanes, argmin, checks and filters."""

EXPLAINED = Path(__file__).with_name("explained.toml")
"""What is said of faults that no trial finds."""


@dataclass(frozen=True)
class Outcome:
    """A fault, and what became of it.

    Members
    -------
    trial : the number of the trial that found it, or None.
    wrong : what was wrong there.
    kind : of one that was not found: ``equivalent``, ``tested`` by others, or empty: nothing is said of it.
    reason : why.
    """

    mutant: Mutant
    trial: int | None
    wrong: str
    kind: str = ""
    reason: str = ""

    @property
    def killed(self) -> bool:
        return self.trial is not None


def study(name: str, count: int, *, seed: int = 1, thorough: bool = True) -> list[Outcome]:
    """Put `count` faults into the core called `name`, each by itself, and run the regression on each.

    Fails where the sound core does not pass it.
    """
    config = Config.from_dict({"name": name, **CORES[name]})
    trials = regression(config, thorough=thorough)
    with tempfile.TemporaryDirectory(prefix="softdepth-mutation-") as folder:
        verilog, found = mutants(config, count, Path(folder), seed)
    sound, *verdicts = run_trials(verilog, trials, [0, *(mutant.number for mutant in found)])
    assert sound.trial is None, f"{name} without a fault: trial {sound.trial}: {sound.wrong}"
    said = tomllib.loads(EXPLAINED.read_text())["explained"]
    return [
        Outcome(mutant, verdict.trial, verdict.wrong, *(_said(mutant, said) if verdict.trial is None else ()))
        for mutant, verdict in zip(found, verdicts, strict=True)
    ]


def _said(mutant: Mutant, explained: list[Mapping[str, str]]) -> tuple[str, str]:
    """The first explanation whose patterns all fit."""
    for each in explained:
        keys = each.keys() - {"kind", "reason"}
        if all(re.search(each[key], getattr(mutant, key)) for key in keys):
            return each["kind"], each["reason"]
    return "", ""
