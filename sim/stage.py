"""Which stage of the gateware a mismatch speaks of, judged by the fixed model.

The core shows its results alone. The model tells what else would have given them: the line above, the
criteria without the fuzzy stage, an excluded candidate. What is said is what the results are consistent
with, the likeliest first; stages have the names of `softdepth.hdl.core.StereoCore`'s docstring.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from softdepth.config import Config
from softdepth.golden import fixed_model
from softdepth.golden.maps import Difference, DisparityMap
from softdepth.golden.pair import Image
from softdepth.sim.compare import mismatches
from softdepth.validity import Validity

JUDGED = 50
"""Differences of a frame, spread over it, that are traced to tell criteria from inference."""


def explain(
    config: Config,
    pairs: Sequence[tuple[Image, Image]],
    expected: Sequence[DisparityMap],
    got: Sequence[DisparityMap],
    limit: int = 5,
) -> list[str]:
    """The first `limit` mismatches of simulated maps, a line each: place, both results, and the stage.

    `expected` are the fixed model's maps of `pairs`. Errors as in `compare.mismatches`.
    """
    frames: dict[int, FrameFault] = {}
    lines = []
    for found in mismatches(expected, got)[:limit]:
        k = found.frame
        if k not in frames:
            frames[k] = FrameFault(config, pairs[k], expected[k], got[k])
        stage = frames[k].stage(Difference(found.y, found.x, found.expected, found.got))
        lines.append(f"{found}; stage: {stage}")
    return lines


class FrameFault:
    """What the differences between the fixed model's map of a pair and the gateware's have in common."""

    def __init__(
        self, config: Config, pair: tuple[Image, Image], expected: DisparityMap, got: DisparityMap
    ) -> None:
        self._config = config
        self._pair = pair
        self._expected = expected
        self._got = got

    def stage(self, difference: Difference) -> str:
        """The stage that one of the differences speaks of, and why."""
        y, x, expected, got = difference
        if got.code != expected.code:
            return "sequencer (validity code)"
        if expected.code == Validity.BORDER:
            return "results (a border pixel's disparity is 0)"
        if self._like is not None:
            return self._like
        trace = fixed_model.trace(*self._pair, self._config, x, y)
        if got.disparity >= len(trace.criteria):
            return "exclusion (the candidate's window leaves the other image)"
        n, s = trace.numerator, trace.denominator
        a, b = expected.disparity, got.disparity
        if n[a] * s[b] == n[b] * s[a]:
            return "argmin (both candidates cost the same)"
        return f"{self._lane}; {a} costs {n[a]}/{s[a]}, {b} costs {n[b]}/{s[b]}"

    @cached_property
    def _like(self) -> str | None:
        """The stage whose fault gives the gateware's map in every pixel that can be compared, if any.

        Those are the pixels that see all candidates, and so do their neighbours.
        """
        full = self._expected.code == Validity.FULL
        inner = full & np.roll(full, 1, axis=1) & np.roll(full, -1, axis=1)
        for stage, alike in self._alternatives():
            departs = (alike.disparity != self._expected.disparity) | (
                self._got.disparity != self._expected.disparity
            )
            compared = inner & (alike.code == Validity.FULL) & departs
            if compared.any() and (alike.disparity == self._got.disparity)[compared].all():
                return f"{stage}, in all {np.count_nonzero(compared)} pixels that tell"
        return None

    def _alternatives(self) -> Iterator[tuple[str, DisparityMap]]:
        """Maps that the frame would have with another stage at fault each."""
        config, (left, right), expected = self._config, self._pair, self._expected
        for axis, where, stage in (
            (0, "line above", "line buffer"),
            (0, "line below", "line buffer"),
            (1, "pixel to the left", "criteria"),
            (1, "pixel to the right", "criteria"),
        ):
            by = 1 if where in ("line above", "pixel to the left") else -1
            moved = DisparityMap(np.roll(expected.disparity, by, axis), np.roll(expected.code, by, axis))
            yield f"{stage} (as of the {where})", moved
        for by in (1, -1):
            if config.reference == "right":
                pair = np.roll(left, by, axis=1), right
            else:
                pair = left, np.roll(right, by, axis=1)
            yield (
                "right columns (as of the other image, moved by a pixel)",
                fixed_model.disparity(*pair, config),
            )
        if config.compensation.reading != "off":
            without = config.override(["compensation.reading=off"])
            yield "compensating rule (as without it)", fixed_model.disparity(left, right, without)
        if config.cost == "fuzzy":
            yield from self._by_criterion()

    def _by_criterion(self) -> Iterator[tuple[str, DisparityMap]]:
        plain = self._config.model_dump(mode="json")
        plain |= {"cost": "sad", "compensation": {"reading": "off"}, "stored_rows": 0}
        for number, criterion in enumerate(self._config.criteria, start=1):
            if criterion.radius:
                sad = Config.from_dict(plain | {"criteria": [criterion.model_dump(mode="json")]})
                stage = f"inference (as by criterion {number} alone)"
                yield stage, fixed_model.disparity(*self._pair, sad)

    @cached_property
    def _lane(self) -> str:
        """Criteria or inference: a cost that grows with its inputs prefers no worse ones."""
        if self._config.cost == "sad":
            return "criteria or argmin"
        found = [d for d in self._expected.differences(self._got) if d.got.code < Validity.BORDER]
        worse = judged = 0
        for y, x, expected, got in found[:: -(-len(found) // JUDGED)]:
            criteria = fixed_model.trace(*self._pair, self._config, x, y).criteria
            if got.disparity < len(criteria):
                judged += 1
                worse += bool((criteria[got.disparity] >= criteria[expected.disparity]).all())
        if worse:
            share = f"{worse} of {judged} candidates taken"
            return f"criteria, argmin or inference ({share} are better in no criterion)"
        return "inference or criteria (every candidate taken is better in a criterion)"
