"""Argmin: exact fractions of either sign, infinite ones, ties, exclusion, every small count."""

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

import pytest
from amaranth.hdl import unsigned

from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, FractionMin, candidate_layout
from tests.support.simulation import Ports, observe, piped

LOW, NUM, DEN, INDICES = -6912, 6656, 4864, 16  # those of MEAN at eight bits
FRACTIONS = candidate_layout(range(LOW, NUM + 1), range(DEN + 1), INDICES)
NUMBERS = candidate_layout(range(NUM + 1), unsigned(0), INDICES)
INFINITE = (1, 0)


class Candidate(NamedTuple):
    num: int
    den: int
    index: int
    excluded: int


def best(candidates: Sequence[Candidate], layout: Any) -> int | None:
    """Index of the smallest cost among those not excluded, the smallest index on a tie."""
    running = [c for c in candidates if not c.excluded]
    if layout is NUMBERS:
        return min(((c.num, c.index) for c in running), default=(0, None))[1]
    # 1 / 0 is infinite.
    costs = [(c.den == 0, Fraction(c.num, c.den or 1), c.index) for c in running]
    return min(costs, default=(0, 0, None))[2]


def candidates(random: Random, count: int, layout: Any) -> list[Candidate]:
    """Candidates with many near and exact ties."""
    plain = layout is NUMBERS
    style = random.randrange(4)
    made = []
    for index in random.sample(range(max(INDICES, count)), count):
        den = random.randint(1, DEN)
        num = random.randint(0, min(5 * den, NUM))
        if style == 1:  # equal fractions of different terms, and close misses
            k = random.randint(1, DEN // 7)
            num, den = 5 * k + random.choice((0, 0, 1)), 7 * k
        elif style == 2:
            num, den = random.choice(
                ((NUM, DEN), (NUM - 1, DEN), (NUM, DEN - 1), (0, 1), (0, DEN), (LOW, 1), (LOW, DEN), INFINITE)
            )
        elif style == 3 and not plain:  # about zero
            num = random.randint(-200, 200)
        if plain:
            num, den = max(num, 0), 0
        made.append(Candidate(num, den, index, random.random() < 0.25))
    if plain and style == 1:
        made = [c._replace(num=7 + c.num % 2) for c in made]
    return made


def side_by_side(random: Random, count: int, layout: Any) -> list[Candidate]:
    """The same in order of their indices, which count from 0; the excluded ones are the last."""
    running = random.choice((count, random.randint(0, count)))
    made = candidates(random, count, layout)
    return [c._replace(index=k, excluded=k >= running) for k, c in enumerate(made)]


def terms(c: Candidate) -> dict[str, int]:
    """A candidate whose place tells its index."""
    return {"num": c.num, "den": c.den, "excluded": c.excluded}


@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
def test_better_of_two(layout: Any) -> None:
    random = Random(2)
    pairs = [candidates(random, 2, layout) for _ in range(300)]
    got = piped(FractionMin(layout), [{"a": a._asdict(), "b": b._asdict()} for a, b in pairs])
    for pair, o in zip(pairs, got, strict=True):
        expected = best(pair, layout)
        if expected is None:
            assert o.excluded
            continue
        assert o.index == expected, pair
        (winner,) = (c for c in pair if c.index == expected)
        assert (o.num, o.den, o.excluded) == (*winner[:2], 0)
    assert any(best(p, layout) is None for p in pairs)


@pytest.mark.parametrize("costs", [((10, 4), (5, 2)), (INFINITE, INFINITE), ((0, 7), (0, 9))])
def test_ties_go_to_the_smaller_index_on_either_side(costs: tuple[tuple[int, int], tuple[int, int]]) -> None:
    low, high = Candidate(*costs[0], 3, 0), Candidate(*costs[1], 9, 0)
    clocks: list[Ports] = [{"a": a._asdict(), "b": b._asdict()} for a, b in ((low, high), (high, low))]
    assert [o.index for o in piped(FractionMin(FRACTIONS), clocks)] == [3, 3]


@pytest.mark.parametrize("finite", [(NUM, 1), (LOW, DEN), (0, 1), (1, DEN)])
def test_an_infinite_cost_loses_against_any_other(finite: tuple[int, int]) -> None:
    """But wins against an excluded candidate."""
    low, high, gone = Candidate(*INFINITE, 3, 0), Candidate(*finite, 9, 0), Candidate(*finite, 1, 1)
    pairs = ((low, high), (high, low), (low, gone), (gone, low))
    clocks: list[Ports] = [{"a": a._asdict(), "b": b._asdict()} for a, b in pairs]
    assert [o.index for o in piped(FractionMin(FRACTIONS), clocks)] == [9, 9, 3, 3]


@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
def test_better_of_two_halves(layout: Any) -> None:
    """Indices count within each half, and the excluded candidates are the upper ones."""
    random = Random(3)
    pairs = []
    for _ in range(300):
        a, b = side_by_side(random, 2, layout)
        pairs.append(
            (a._replace(index=random.randrange(INDICES)), b._replace(index=random.randrange(INDICES)))
        )
    got = piped(FractionMin(layout, halves=True), [{"a": a._asdict(), "b": b._asdict()} for a, b in pairs])
    taken = set()
    for (a, b), o in zip(pairs, got, strict=True):
        winner = best((a._replace(index=0), b._replace(index=1)), layout)
        if winner is None:
            assert o.excluded
            continue
        chosen = (a, b)[winner]
        assert (o.num, o.den, o.index, o.excluded) == (*chosen[:2], INDICES * winner + chosen.index, 0)
        taken.add((winner, b.excluded))
    assert taken == {(0, 0), (0, 1), (1, 0)}


@pytest.mark.parametrize("layout", [FRACTIONS, NUMBERS])
@pytest.mark.parametrize("count", [*range(1, 12), 16, 21])
def test_tree(count: int, layout: Any) -> None:
    """Counts that are no powers of two leave places that wait on some levels."""
    random = Random(count)
    sets = [side_by_side(random, count, layout) for _ in range(60)]
    sets += [  # every place wins once, and ties with all after it
        [Candidate(9 + (k < winner), 0 if layout is NUMBERS else 5, k, 0) for k in range(count)]
        for winner in range(count)
    ]
    num, den = (layout[name].shape for name in ("num", "den"))
    got = piped(ArgminTree(num, den, count), [{"i": [terms(c) for c in s]} for s in sets])
    winners = set()
    for s, o in zip(sets, got, strict=True):
        expected = best(s, layout)
        assert bool(o.excluded) == (expected is None), s
        if expected is not None:
            assert (o.index, o.num, o.den) == (expected, *s[expected][:2]), s
            winners.add(expected)
    assert winners == set(range(count))


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
        assert (None if o.excluded else o.index) == best(sequence, layout), sequence
