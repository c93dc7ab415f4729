"""Argmin: exact fractions, ties, exclusion, and every small number of candidates."""

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

import pytest

from softdepth.hdl.argmin import ArgminSequence, ArgminTree, FractionMin, candidate_layout

from .support import Ports, observe, piped

NUM, DEN, INDICES = 14080, 2816, 16  # as `min` at eight bits has them
FRACTIONS = candidate_layout(NUM, DEN, INDICES)
NUMBERS = candidate_layout(NUM, 0, INDICES)


class Candidate(NamedTuple):
    num: int
    den: int
    index: int
    excluded: int


def best(candidates: Sequence[Candidate]) -> int | None:
    """Index of the smallest cost among those not excluded, the smallest index on a tie."""
    running = [c for c in candidates if not c.excluded]
    return min(running, key=lambda c: (Fraction(c.num, c.den or 1), c.index)).index if running else None


def candidates(random: Random, count: int, layout: Any) -> list[Candidate]:
    """Candidates with many near and exact ties."""
    plain = layout is NUMBERS
    style = random.randrange(4)
    made = []
    for index in random.sample(range(INDICES), count):
        den = random.randint(1, DEN)
        num = random.randint(0, min(5 * den, NUM))
        if style == 1:  # equal fractions of different terms, and close misses
            k = random.randint(1, DEN // 7)
            num, den = 5 * k + random.choice((0, 0, 1)), 7 * k
        elif style == 2:
            num, den = random.choice(((NUM, DEN), (NUM - 1, DEN), (NUM, DEN - 1), (0, 1), (0, DEN)))
        made.append(Candidate(num, 0 if plain else den, index, random.random() < 0.25))
    if plain and style == 1:
        made = [c._replace(num=7 + c.num % 2) for c in made]
    return made


@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
def test_better_of_two(layout: Any) -> None:
    random = Random(2)
    pairs = [candidates(random, 2, layout) for _ in range(300)]
    got = piped(FractionMin(layout), [{"a": a._asdict(), "b": b._asdict()} for a, b in pairs])
    for pair, o in zip(pairs, got, strict=True):
        expected = best(pair)
        if expected is None:
            assert o.excluded
            continue
        assert o.index == expected, pair
        (winner,) = (c for c in pair if c.index == expected)
        assert (o.num, o.den, o.excluded) == (*winner[:2], 0)
    assert any(best(p) is None for p in pairs)


def test_ties_go_to_the_smaller_index_on_either_side() -> None:
    low, high = Candidate(10, 4, 3, 0), Candidate(5, 2, 9, 0)
    clocks: list[Ports] = [{"a": a._asdict(), "b": b._asdict()} for a, b in ((low, high), (high, low))]
    assert [o.index for o in piped(FractionMin(FRACTIONS), clocks)] == [3, 3]


@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
@pytest.mark.parametrize("count", range(1, 10))
def test_tree(count: int, layout: Any) -> None:
    random = Random(count)
    sets = [sorted(candidates(random, count, layout), key=lambda c: c.index) for _ in range(60)]
    got = piped(ArgminTree(layout, count), [{"i": [c._asdict() for c in s]} for s in sets])
    for s, o in zip(sets, got, strict=True):
        expected = best(s)
        assert (None if o.excluded else o.index) == expected, s


@pytest.mark.parametrize("rate", [1.0, 0.5])
@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
@pytest.mark.parametrize("count", range(1, 10))
def test_sequence(count: int, layout: Any, rate: float) -> None:
    """Sequences follow one another without a gap, or with gaps between any two candidates."""
    random = Random(count)
    clocks: list[Ports] = []
    ends: list[tuple[int, list[Candidate]]] = []
    for _ in range(25):
        sequence = candidates(random, count, layout)
        if random.random() < 0.5:  # the core brings the far end first
            sequence.sort(key=lambda c: -c.index)
        for k, c in enumerate(sequence):
            while random.random() >= rate:
                junk = candidates(random, 1, layout)[0]
                clocks.append({"valid": 0, "last": random.getrandbits(1), "i": junk._asdict()})
            clocks.append({"valid": 1, "last": k == count - 1, "i": c._asdict()})
        ends.append((len(clocks) - 1, sequence))
    dut = ArgminSequence(layout, count)
    idle: list[Ports] = [{"valid": 0}] * dut.latency
    seen = observe(dut, [*clocks, *idle], "o")
    for end, sequence in ends:
        o = layout.from_bits(seen[end + dut.latency])
        assert (None if o.excluded else o.index) == best(sequence), sequence
