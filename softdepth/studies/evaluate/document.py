"""What an evaluation finds: ``evaluate.json``."""

from typing import Any

from pydantic import BaseModel

from softdepth.studies.evaluate.lanes import LaneFigures
from softdepth.studies.evaluate.score import Score, Sparsification, geometric_mean

CLEAN = "clean"
"""The pairs as they are, beside the ways of `degrade`."""


class SceneResult(BaseModel):
    """A scene: its group, size, and the scores by way and method; confidence by preset, of the clean pair.

    Members
    -------
    levels, bad_levels : for each confidence 0 .. 255, how many measured pixels of known truth have it, and
        how many of those are off by more than 1 px.
    mismatches : pixels in which the simulated gateware departs from its model, by preset; empty where
        it was not simulated.
    """

    name: str
    group: str
    width: int
    height: int
    scores: dict[str, dict[str, Score]]
    sparsification: dict[str, Sparsification] = {}
    levels: dict[str, list[int]] = {}
    bad_levels: dict[str, list[int]] = {}
    mismatches: dict[str, int] = {}


class Evaluation(BaseModel):
    """All scenes, by name.

    Members
    -------
    presets : our configurations, by name, complete.
    hashes : what names them.
    fuzzy : the names of those that were added to compare costs.
    ablations : of those that are `robust-small` with a saving taken back.
    lanes : what a lane of those in `fuzzy` takes, where it was measured.
    methods : every method's name and title, in the order of the tables.
    ways : the ways in which pairs were degraded, with ``clean`` first.
    """

    engine: str
    presets: dict[str, dict[str, Any]]
    hashes: dict[str, str]
    fuzzy: list[str]
    ablations: list[str] = []
    lanes: dict[str, LaneFigures] = {}
    methods: dict[str, str]
    ways: list[str]
    scenes: list[SceneResult]

    def score(self, method: str, way: str = CLEAN, group: str | None = None) -> Score:
        """The mean over scenes, or over those of one group."""
        found = [s.scores[way][method] for s in self.scenes if group in (None, s.group)]

        def mean(name: str) -> float:
            return sum(getattr(one, name) for one in found) / len(found)

        measured = None if any(one.measured is None for one in found) else mean("measured")
        four = {name: mean(name) for name in ("nonocc1", "nonocc2", "all1", "all2")}
        return Score(**four, measured=measured)

    def ratio(self, method: str, to: str, way: str = CLEAN, group: str | None = None) -> float:
        """The geometric mean over scenes of the ratio of two methods' errors."""
        return geometric_mean(
            s.scores[way][method].error / max(s.scores[way][to].error, 1e-3)
            for s in self.scenes
            if group in (None, s.group)
        )

    @property
    def groups(self) -> list[str]:
        """The scenes' groups, in order."""
        return sorted({scene.group for scene in self.scenes})
