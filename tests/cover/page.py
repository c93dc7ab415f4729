"""What is reached of lines, toggles and the functional plan, as a part of docs/verification.md."""

import re
import tomllib
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softdepth.templates import render
from tests.cover.counts import Found, Point
from tests.cover.functional import Bin

PART = "coverage"
ROOMS = ("front", "costs", "winners", "post", "")
KINDS = {"line": "lines", "toggle": "bits that change"}
EXPLAINED = Path(__file__).with_name("explained.toml")
"""What is said of points that no trial reaches."""


@dataclass(frozen=True)
class Explanation:
    """Patterns that a point must fit, each if it is there, and why such a point is not reached."""

    reason: str
    kind: str = ""
    core: str = ""
    block: str = ""
    what: str = ""

    def fits(self, core: str, point: Point) -> bool:
        """Whether it explains this point of that core."""
        values = {"kind": point.kind, "core": core, "block": point.block, "what": point.what}
        return all(re.search(getattr(self, key), value) for key, value in values.items())


def explanations() -> list[Explanation]:
    """Those of the file, in its order: the first that fits is taken."""
    return [Explanation(**each) for each in tomllib.loads(EXPLAINED.read_text())["explained"]]


Missed = Mapping[str, Sequence[tuple[str, Point]]]
"""By reason, empty where there is none, the points that are not reached and their cores."""


def missed(found: Mapping[str, Sequence[Found]], said: Sequence[Explanation]) -> Missed:
    """What is not reached, by why."""
    by_reason: dict[str, list[tuple[str, Point]]] = defaultdict(list)
    for core, each in found.items():
        for point in (one.point for one in each if not one.reached):
            reason = next((one.reason for one in said if one.fits(core, point)), "")
            by_reason[reason].append((core, point))
    return by_reason


def page(
    found: Mapping[str, Sequence[Found]],
    said: Sequence[Explanation],
    plan: Collection[Bin],
    hit: Collection[Bin],
    measured: str,
) -> str:
    """What was reached by core and room, what was not, with the reason, and bins of the plan."""
    return render(
        "tests.cover",
        "page.md",
        measured=measured,
        rooms=ROOMS,
        reached=[
            (core, title, _by_room([one for one in each if one.point.kind == kind]))
            for core, each in found.items()
            for kind, title in KINDS.items()
        ],
        unreached=_unreached(missed(found, said)),
        plan=plan,
        absent=sorted(set(plan) - set(hit)),
    )


def _by_room(points: Sequence[Found]) -> list[str]:
    """The share that is reached in each room, and of all."""
    rooms = [[each for each in points if each.point.room == room] for room in ROOMS]
    return [_share(each) for each in (*rooms, points)]


def _share(found: Sequence[Found]) -> str:
    if not found:
        return "-"
    reached = sum(each.reached for each in found)
    # Never rounded up to 100 %.
    return f"{1000 * reached // len(found) / 10:.1f}% of {len(found):,}"


def _unreached(by_reason: Missed) -> Iterator[dict[str, Any]]:
    """For each reason which cores and places it is of, and of how many points."""
    for reason, points in by_reason.items():
        yield {
            "cores": list(dict.fromkeys(core for core, _ in points)),
            "places": sorted({_place(point) for _, point in points}),
            "count": len(points),
            "reason": reason,
        }


def _place(point: Point) -> str:
    """The block and the signal."""
    signal = re.split(r"[:\[]", point.what)[0]
    return f"{point.block}: {signal}" if point.block else signal
