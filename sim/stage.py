"""Which stage of the gateware a mismatch points to, judged by the fixed model.

The core shows only its results. The model finds out what else would have given them: the line above, one
criterion without the fuzzy stage, an excluded candidate. It names a stage that would explain the results;
stages have the names of docs/gateware.md.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from softdepth.golden import fixed_model
from softdepth.golden.front.pair import Image
from softdepth.golden.maps import DisparityMap
from softdepth.hdl.costs.comparison import by_windows
from softdepth.sim.compare import Mismatch, mismatches
from softdepth.spec.config import Config, Sad
from softdepth.spec.validity import Validity

Pair = tuple[Image, Image]
Maps = Sequence[DisparityMap]

JUDGED = 50
"""Mismatches of a frame, spread over it, that are traced to narrow the stages down."""


def explain(config: Config, pairs: Sequence[Pair], expected: Maps, got: Maps, limit: int = 5) -> list[str]:
    """The first `limit` mismatches of simulated maps, a line each: place, both results, and the stage.

    `expected` are the fixed model's maps of `pairs`. Errors as in `compare.mismatches`.
    """
    shown = mismatches(expected, got)[:limit]
    frames = {k: _Frame(config, pairs[k], expected[k], got[k]) for k in {found.frame for found in shown}}
    return [f"{found}; stage: {frames[found.frame].stage(found)}" for found in shown]


class _Frame:
    """A frame that came out wrong: what its mismatches have in common is worked out once."""

    def __init__(self, config: Config, pair: Pair, expected: DisparityMap, got: DisparityMap) -> None:
        self._config = config
        self._pair = pair
        self._expected = expected
        self._got = got

    def stage(self, found: Mismatch) -> str:
        """The stage that one of its mismatches points to, and why."""
        if not by_windows(self._config):
            return self._stage_of_whole(found)
        if found.got.code != found.expected.code:
            return "sequencer (validity code)"
        if found.expected.code == Validity.BORDER:
            return "results (a border pixel's disparity is 0)"
        if self._like is not None:
            return self._like
        trace = fixed_model.trace(*self._pair, self._config, found.x, found.y)
        n, s = trace.numerator, trace.denominator
        a, b = (each.disparity - trace.first for each in (found.expected, found.got))
        if not 0 <= b < len(n):
            return "exclusion (the candidate's window leaves the other image)"
        if n[a] * s[b] == n[b] * s[a]:
            return "argmin (both candidates cost the same)"
        costs = (f"{k + trace.first} costs {n[k]}/{s[k]}" for k in (a, b))
        return f"{self._lane}; {', '.join(costs)}"

    def _stage_of_whole(self, found: Mismatch) -> str:
        """The last stage behind the winners that explains the result if its work is left out."""
        if found.got.code != found.expected.code:
            codes = {found.got.code, found.expected.code}
            if Validity.BORDER in codes:
                return "border band"
            if Validity.ISLAND in codes:
                return "island"
            if Validity.NOTHING in codes:
                return "fill"
            return "costs, right winner or check"
        if found.got.disparity == found.expected.disparity:
            return "neighbours (confidence)"
        maps = fixed_model.stages(*self._pair, self._config).maps
        for (_, before), (name, after) in reversed(list(pairwise(maps.items()))):
            values = before.disparity[found.y, found.x], after.disparity[found.y, found.x]
            if values[0] == found.got.disparity != values[1]:
                return f"{name} (as without it)"
        return "costs, winners or post"

    @cached_property
    def _like(self) -> str | None:
        """The stage whose fault gives the gateware's map in every pixel that can be compared, if any.

        Those are the pixels that see all candidates, as do their neighbours.
        """
        expected, got = self._expected, self._got
        full = expected.code == Validity.FULL
        inner = full & np.roll(full, 1, axis=1) & np.roll(full, -1, axis=1)
        for stage, alike in self._alternatives():
            departs = (alike.disparity != expected.disparity) | (got.disparity != expected.disparity)
            compared = inner & (alike.code == Validity.FULL) & departs
            if compared.any() and (alike.disparity == got.disparity)[compared].all():
                return f"{stage}, in all {np.count_nonzero(compared)} pixels that tell"
        return None

    def _alternatives(self) -> Iterator[tuple[str, DisparityMap]]:
        """Maps that the frame would have, each with another stage at fault."""
        config, (left, right), expected = self._config, self._pair, self._expected
        for stage, by, axis in (
            ("line buffer (as of the line above)", 1, 0),
            ("line buffer (as of the line below)", -1, 0),
            ("criteria (as of the pixel to the left)", 1, 1),
            ("criteria (as of the pixel to the right)", -1, 1),
        ):
            disparity, code = np.roll(expected.disparity, by, axis), np.roll(expected.code, by, axis)
            yield stage, DisparityMap(disparity, code)
        for by in (1, -1):
            moved = {"left": (left, np.roll(right, by, 1)), "right": (np.roll(left, by, 1), right)}
            stage = "right columns (as of the other image, moved by a pixel)"
            yield stage, fixed_model.disparity(*moved[config.reference], config)
        if config.compensation.reading != "off":
            without = config.override(["compensation.reading=off"])
            yield "compensating rule (as without it)", fixed_model.disparity(left, right, without)
        plain = config.model_dump(mode="json")
        plain |= {"cost": "sum", "compensation": {"reading": "off"}, "stored_rows": 0}
        for number, criterion in enumerate(config.criteria, start=1):
            if config.cost == "fuzzy" and isinstance(criterion, Sad) and criterion.radius:
                sad = Config.from_dict(plain | {"criteria": [criterion.model_dump(mode="json")]})
                stage = f"inference (as by criterion {number} alone)"
                yield stage, fixed_model.disparity(left, right, sad)

    @cached_property
    def _lane(self) -> str:
        """The remaining stages: a cost that grows with its inputs never prefers worse ones, argmin may."""
        if self._config.cost == "sum":
            return "criteria or argmin"
        found = [d for d in self._expected.differences(self._got) if d.got.code < Validity.BORDER]
        better = []
        for y, x, expected, got in found[:: -(-len(found) // JUDGED)]:
            trace = fixed_model.trace(*self._pair, self._config, x, y)
            a, b = (each.disparity - trace.first for each in (expected, got))
            if 0 <= b < len(trace.criteria):
                better.append((trace.criteria[b] < trace.criteria[a]).any())
        worse = better.count(False)
        stages = "criteria, inference or argmin" if worse else "criteria or inference"
        return f"{stages} ({worse} of {len(better)} candidates taken are better in no criterion)"
