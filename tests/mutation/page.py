"""The study of faults as a part of docs/verification.md."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

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
    missed = [(name, each) for name, outcomes in found.items() for each in outcomes if not each.killed]
    lines = [
        f"{len(everything)} faults, of which {sum(each.killed for each in everything)} are found"
        f" ({rate(everything):.1%}). {measured}.",
        "",
        f"| core | {' | '.join(room or 'several rooms' for room in ROOMS)} | found |",
        f"|---|{'---:|' * (len(ROOMS) + 1)}",
        *(_row(name, outcomes) for name, outcomes in found.items()),
        "",
        f"How they were noticed: {', '.join(_by_what(everything))}.",
        "",
        f"The {len(missed)} that are not found:",
        "",
        "| core | block | line | fault | why |",
        "|---|---|---|---|---|",
        *(
            f"| {name} | {each.mutant.block or 'of several'} | {_code(each.mutant.code)} | {each.mutant.what}"
            f" | {KINDS[each.kind]}{': ' if each.reason else ''}{each.reason} |"
            for name, each in missed
        ),
    ]
    return "\n".join(lines)


def _row(name: str, outcomes: Sequence[Outcome]) -> str:
    rooms = []
    for room in ROOMS:
        there = [each for each in outcomes if each.mutant.room == room]
        rooms.append(f"{sum(each.killed for each in there)} of {len(there)}" if there else "-")
    return f"| {name} | {' | '.join(rooms)} | {rate(outcomes):.1%} |"


def _by_what(outcomes: Sequence[Outcome]) -> Iterator[str]:
    kinds = Counter(
        " ".join(word for word in each.wrong.split() if not word.isdigit())
        for each in outcomes
        if each.killed
    )
    return (f"{what} ({count})" for what, count in kinds.most_common())


def _code(code: str) -> str:
    """A line in a cell of a table."""
    return f"`{code.replace('|', chr(92) + '|')}`" if code else "-"
