"""From measurements to what is wrong: which limits are crossed, and by how much."""

import math
from dataclasses import dataclass
from typing import Literal

from softdepth.inspect.measurements import Measurements
from softdepth.inspect.span import Span
from softdepth.spec.config import Config

Code = Literal[
    "same",
    "unmatched",
    "bare",
    "exchanged",
    "unrectified",
    "rows",
    "brightness",
    "contrast",
    "uneven",
    "negative",
    "short",
    "needless",
]
"""All findings. ``needless`` only concerns the configuration's cost; all others spoil results."""

BARE = 0.85
"""Share without texture above which a pair has nothing to match. Plain walls and furniture reach 0.76."""
FEWEST_POINTS = 20
LEAST_MATCHED = 0.05
"""Points in both views, and their share of the keypoints, that views of one scene have."""
ROWS = 0.6
"""Offset in rows from which it is reported; the fit's own error and the residue of usual calibrations are
below 0.3."""
ROW_CHANGE = 0.8
"""Change of the offset over the image likewise; usual calibrations stay below 0.7, and 0.5 degrees exceed it
from some 200 columns on."""
ROWS_REDUCED = 0.25
"""The same where images are reduced, in rows of the reduced pair: what keypoints cannot tell is not told."""
BRIGHTNESS, CONTRAST, UNEVEN = 1.08, 1.12, 0.1
"""Factors between the views, and their spread over the image, from which they are reported."""
NEGATIVE, POSITIVE = 0.02, 0.05
"""Share of negative disparities from which it is reported; share of positive ones below which the views are
exchanged."""
OUTSIDE = 0.015
"""Share of matched pixels beyond the range from which it is reported."""
NEEDLESS = 2
"""Factor between the candidates there are and those that would do."""
MARGIN = 2
"""Pixels that a range that would do has beyond the largest disparity seen."""
STEP = 8
"""Ranges that would do are multiples of the lanes, and of at least so many candidates."""
MOST = 256
"""The largest number of candidates of a core."""


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with a pair, and its figures by name (:mod:`softdepth.inspect.texts`)."""

    code: Code
    figures: dict[str, float]


@dataclass(frozen=True)
class Range:
    """A range that would do.

    Members
    -------
    first : the smallest disparity; 0 unless there are negative ones.
    disparities : candidates from `first` on, not limited to what a core can have.
    """

    first: int
    disparities: int


def needed(span: Span, lanes: int, first: int = 0) -> Range:
    """The range that holds a pair's disparities, for a core of so many lanes; it may exceed `MOST`.

    It begins at `first`, unless there are disparities below.
    """
    if span.below(first - 1) >= NEGATIVE:
        lowest = math.floor(span.low) - 1
        first = lowest if span.low < -1 else max(lowest, 0)
    count = max(1, math.ceil(span.high) + MARGIN + 1 - first)
    step = lanes * math.ceil(STEP / lanes)
    return Range(first, math.ceil(count / step) * step)


def find(measured: Measurements, config: Config) -> list[Finding]:
    """What is wrong with a pair for a core with the candidates of `config`, gravest first.

    Its lanes decide which other numbers of candidates are named as remedies.
    """
    if measured.same:
        return [Finding("same", {})]
    found: list[Finding] = []
    if measured.bare > BARE:
        found.append(Finding("bare", {"share": measured.bare}))
    elif measured.points < max(FEWEST_POINTS, LEAST_MATCHED * measured.keypoints):
        points = {"points": float(measured.points), "keypoints": float(measured.keypoints)}
        found.append(Finding("unmatched", points))
    if measured.points < FEWEST_POINTS:
        return found  # anything more would be chance
    span, rows = measured.span, _rows(measured)
    ranges: list[Finding] = []
    if span is not None and exchanged(span):
        ranges = [_exchange(span, config)]
    elif span is not None and not any(one.code == "unrectified" for one in rows):
        ranges = _range(span, config)  # rectifying moves these, so they are not judged before
    spoilt = [one for one in ranges if one.code != "needless"]
    thrifty = [one for one in ranges if one.code == "needless"]
    return [*found, *spoilt, *rows, *_light(measured), *thrifty]


def exchanged(span: Span) -> bool:
    """Whether the disparities are those of a pair whose views are exchanged: next to none is positive."""
    return span.above(1) < POSITIVE and span.below(-1) >= POSITIVE


def _exchange(span: Span, config: Config) -> Finding:
    would_do = needed(span.mirrored(), config.lanes, config.min_disparity).disparities
    figures = {"share": span.below(0), "low": span.low, "high": span.high}
    return Finding("exchanged", {**figures, "given": config.disparities, "disparities": would_do})


def _rows(measured: Measurements) -> list[Finding]:
    rows = measured.rows
    if rows is None:
        return []
    blind = ROWS_REDUCED * measured.scale
    first, last = rows.ends
    if rows.change > max(ROW_CHANGE, blind):
        turn = math.degrees(math.atan2(rows.across, measured.width))
        return [Finding("unrectified", {"first": first, "last": last, "degrees": turn})]
    if abs(rows.offset) > max(ROWS, blind):
        return [Finding("rows", {"offset": rows.offset})]
    return []


def _light(measured: Measurements) -> list[Finding]:
    light = measured.light
    if light is None:
        return []
    found: list[Finding] = []
    if abs(math.log(light.brightness)) > math.log(BRIGHTNESS):
        figures = {"ratio": light.brightness, "contrast": light.contrast, "gamma": light.gamma}
        found.append(Finding("brightness", figures))
    elif abs(math.log(light.contrast)) > math.log(CONTRAST):
        found.append(Finding("contrast", {"ratio": light.contrast}))
    if light.uneven > UNEVEN:
        found.append(Finding("uneven", {"spread": light.uneven}))
    return found


def _range(span: Span, config: Config) -> list[Finding]:
    first, last = config.min_disparity, config.max_disparity
    would_do = needed(span, config.lanes, first)
    figures: dict[str, float] = {
        "low": span.low,
        "high": span.high,
        "first": first,
        "last": last,
        "given": config.disparities,
        "wanted": would_do.first,
        "disparities": would_do.disparities,
    }
    if would_do.first < first:
        return [Finding("negative", {"share": span.below(first - 0.5), **figures})]
    outside = span.above(last + 0.5)
    if outside >= OUTSIDE:
        return [Finding("short", {"share": outside, **figures})]
    if would_do.disparities * NEEDLESS <= config.disparities:
        return [Finding("needless", figures)]
    return []
