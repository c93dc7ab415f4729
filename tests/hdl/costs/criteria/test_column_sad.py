"""ColumnSad: every split between computed and stored rows, against sums in plain Python."""

from itertools import product
from random import Random

import pytest

from softdepth.hdl.costs.criteria.column_sad import ColumnSad, column_maximum
from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.spec.pixel import PixelFormat
from tests.support.simulation import Ports, looked_up, observe

WINDOWS = [(1,), (3,), (5,), (1, 3), (3, 5, 7), (1, 5), (3, 9), (1, 3, 5, 7, 9), (5, 7, 11)]
SPLITS = [
    *((windows, stored) for windows in WINDOWS for stored in range(windows[-1])),
    *(((15,), stored) for stored in (0, 1, 7, 13, 14)),
]
PLACES = 5

Pixel = list[int]
Rows = list[list[Pixel]]


def pixel_pair(random: Random) -> tuple[Pixel, Pixel]:
    """Channels that are equal, next to each other, as far apart as can be, or anything."""
    style = random.randrange(4)
    if style == 0:
        channels = [(value, value) for value in random.choices((0, 255, random.randrange(256)), k=3)]
    elif style == 1:
        channels = [
            (value, value + random.choice((-1, 0, 1))) for value in random.choices(range(1, 255), k=3)
        ]
    elif style == 2:
        channels = [(random.choice((0, 255)), random.choice((0, 255))) for _ in range(3)]
    else:
        channels = [(random.randrange(256), random.randrange(256)) for _ in range(3)]
    return [a for a, _ in channels], [b for _, b in channels]


def cost(left: Pixel, right: Pixel) -> int:
    return sum(abs(a - b) for a, b in zip(left, right, strict=True))


def signs(left: Pixel, right: Pixel) -> tuple[int, ...]:
    return tuple((a > b) - (a < b) for a, b in zip(left, right, strict=True))


def check(windows: tuple[int, ...], stored: int, left: Rows, right: Rows, seed: int) -> None:
    """Run rows of pixels through, line after line, with idle clocks in which the inputs are anything.

    All columns are compared whose stored rows were computed before.
    """
    random = Random(seed)
    height = windows[-1]
    drive: list[Ports] = []
    entered: list[tuple[int, int, int]] = []  # clock, line, place

    def idle() -> Ports:
        junk = [pixel_pair(random) for _ in range(height - stored)]
        return {
            "valid": 0,
            "place": random.randrange(PLACES),
            "left": [a for a, _ in junk],
            "right": [b for _, b in junk],
        }

    for y in range(len(left) - height + 1):
        for place in range(len(left[0])):
            while random.random() < 0.2:
                drive.append(idle())
            entered.append((len(drive), y, place))
            rows = range(y + stored, y + height)
            drive.append(
                {
                    "valid": 1,
                    "place": place,
                    "left": [left[row][place] for row in rows],
                    "right": [right[row][place] for row in rows],
                }
            )
    dut = ColumnSad(windows, PixelFormat.RGB8, stored, PLACES)
    drive = looked_up([*drive, *(idle() for _ in range(dut.latency))], coming="valid")
    seen = observe(dut, drive, "o")
    compared = 0
    for clock, y, place in entered:
        if y < stored:
            continue
        costs = [cost(left[row][place], right[row][place]) for row in range(y, y + height)]
        expected = {f"c{w}": sum(costs[(height - w) // 2 : (height + w) // 2]) for w in windows}
        got = dut.o.shape().from_bits(seen[LOOKUP_AHEAD + clock + dut.latency])
        assert {name: got[name] for name in expected} == expected, (y, place)
        compared += 1
    assert compared >= PLACES


@pytest.mark.parametrize(("windows", "stored"), SPLITS)
def test_costs_of_all_heights(windows: tuple[int, ...], stored: int) -> None:
    random = Random(100 * windows[-1] + stored)
    lines = stored + 16
    pairs = [[pixel_pair(random) for _ in range(PLACES)] for _ in range(lines + windows[-1] - 1)]
    left, right = ([[pair[side] for pair in row] for row in pairs] for side in (0, 1))
    check(windows, stored, left, right, seed=1)


@pytest.mark.parametrize(("windows", "stored"), [((1,), 0), ((3, 5, 7), 0), ((3, 5, 7), 3), ((3,), 1)])
def test_every_sign_of_every_channel_in_every_row(windows: tuple[int, ...], stored: int) -> None:
    """Negations that are one short must get their 1, in whichever row and channel they are."""
    random = Random(4)
    relations = list(product((-1, 0, 1), repeat=3))
    height = windows[-1]
    left: Rows = []
    right: Rows = []
    deck: list[tuple[int, ...]] = []
    for _ in range(len(relations) // PLACES * 3 + stored + height):
        row_left, row_right = [], []
        for _ in range(PLACES):
            deck = deck or random.sample(relations, len(relations))
            relation = deck.pop()
            near = random.choice(((100, 101), (0, 1), (254, 255), (0, 255), (17, 240)))
            a = [near[max(r, 0)] for r in relation]
            row_left.append(a)
            row_right.append([x if r == 0 else near[r < 0] for x, r in zip(a, relation, strict=True)])
        left.append(row_left)
        right.append(row_right)
    for offset in range(height):
        last = len(left) - height + 1 + offset
        seen = {
            signs(a, b) for y in range(stored + offset, last) for a, b in zip(left[y], right[y], strict=True)
        }
        assert len(seen) == len(relations), f"row {offset} has not seen all of them"
    check(windows, stored, left, right, seed=2)


@pytest.mark.parametrize("stored", [0, 2, 6])
def test_the_largest_costs(stored: int) -> None:
    """Black on white and white on black: no sum is cut."""
    windows = (3, 5, 7)
    rows = 7 + stored + 3
    black, white = [[[v] * 3] * PLACES for v in (0, 255)]
    left = [(black, white)[y % 2] for y in range(rows)]
    right = [(white, black)[y % 2] for y in range(rows)]
    check(windows, stored, left, right, seed=3)
    assert [column_maximum(w, PixelFormat.RGB8) for w in windows] == [w * 3 * 255 for w in windows]
