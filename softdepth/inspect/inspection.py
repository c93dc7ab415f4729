"""A pair inspected: measured, judged, and ready to be shown or written as JSON."""

import json
from dataclasses import asdict, dataclass

import numpy as np

from softdepth.inspect import findings, texts
from softdepth.inspect.findings import Finding, Range
from softdepth.inspect.measurements import Measurements, measure
from softdepth.spec.config import Config


@dataclass(frozen=True)
class Inspection:
    """What was found about a pair, for a core with certain candidates.

    Members
    -------
    measured : all figures.
    findings : what is wrong, gravest first; empty for a sound pair.
    range : a range that would do, or None where too few points tell. Of exchanged views, it is that of the
        views in their right order.
    """

    measured: Measurements
    findings: list[Finding]
    range: Range | None

    @property
    def lines(self) -> list[str]:
        """One line a finding, with figure and remedy."""
        return [texts.line(finding) for finding in self.findings]

    def json(self) -> str:
        """All of it; ``docs/inspect.md`` names the keys."""
        measured = {key: getattr(self.measured, key) for key in self.measured.__dataclass_fields__}
        measured["rows"] = self.measured.rows and asdict(self.measured.rows)
        measured["light"] = self.measured.light and asdict(self.measured.light)
        span = self.measured.span
        measured["span"] = span and {"low": span.low, "high": span.high, "density": span.density}
        found = [
            {
                "code": finding.code,
                "figures": finding.figures,
                "problem": texts.problem(finding),
                "remedy": texts.remedy(finding),
            }
            for finding in self.findings
        ]
        return json.dumps(
            {"measured": measured, "range": self.range and asdict(self.range), "findings": found}, indent=2
        )


def inspect(left: np.ndarray, right: np.ndarray, config: Config) -> Inspection:
    """Inspect two images of one size, uint8, RGB (H x W x 3) or gray (H x W), in well under a second."""
    measured = measure(left, right)
    span = measured.span
    would_do = None
    if span is not None:
        ordered = span.mirrored() if findings.exchanged(span) else span
        would_do = findings.needed(ordered, config.lanes, config.min_disparity)
    return Inspection(measured, findings.find(measured, config), would_do)
