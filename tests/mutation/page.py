"""The study of faults as a part of docs/verification.md."""

from collections import Counter
from collections.abc import Mapping, Sequence

from softdepth.templates import render
from tests.mutation.study import Outcome

PART = "mutation"
ROOMS = ("front", "costs", "winners", "post", "")
KINDS = {
    "equivalent": "no input can tell it from the sound core",
    "tested": "found by other tests",
    "harmless": "later, but never wrong",
    "": "not explained",
}


def rate(outcomes: Sequence[Outcome]) -> float:
    """The share of faults that are found."""
    return sum(outcome.killed for outcome in outcomes) / len(outcomes)


def page(found: Mapping[str, Sequence[Outcome]], measured: str) -> str:
    """What was found by core and room, and each fault that was not, with the reason."""
    everything = [outcome for outcomes in found.values() for outcome in outcomes]
    return render(
        "tests.mutation",
        "page.md",
        measured=measured,
        everything=everything,
        rate=rate,
        rooms=ROOMS,
        cores=[(name, _by_room(outcomes), rate(outcomes)) for name, outcomes in found.items()],
        noticed=_by_what(everything),
        missed=[(name, each) for name, outcomes in found.items() for each in outcomes if not each.killed],
        kinds=KINDS,
    )


def _by_room(outcomes: Sequence[Outcome]) -> list[str]:
    rooms = []
    for room in ROOMS:
        there = [each for each in outcomes if each.mutant.room == room]
        rooms.append(f"{sum(each.killed for each in there)} of {len(there)}" if there else "-")
    return rooms


def _by_what(outcomes: Sequence[Outcome]) -> list[tuple[str, int]]:
    """What was wrong, whichever the number, and how often, the most frequent first."""
    kinds = Counter(
        " ".join(word for word in each.wrong.split() if not word.isdigit())
        for each in outcomes
        if each.killed
    )
    return kinds.most_common()
