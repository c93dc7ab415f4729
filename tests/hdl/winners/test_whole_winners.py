"""Right winners along the diagonal, neighbours and runner-up, sixteenths, confidence: against plain loops."""

from fractions import Fraction

import numpy as np
import pytest
from amaranth.lib import data

from softdepth.hdl.costs.layout import sum_layout
from softdepth.hdl.winners.confidence import Confidence
from softdepth.hdl.winners.left_right import LeftRight
from softdepth.hdl.winners.neighbours import Neighbours
from softdepth.hdl.winners.number import Number
from softdepth.hdl.winners.right_winner import right_winner
from softdepth.hdl.winners.sixteenths import Sixteenths
from softdepth.spec.config import QUOTIENT_BITS, Config
from tests.support.simulation import observe, piped

GEOMETRIES = [(4, 2), (3, 1), (2, 3), (1, 4)]
RIGHT_GEOMETRIES = [*GEOMETRIES, (9, 1), (2, 4), (2, 5), (3, 6), (1, 9)]
"""Also lanes that have the same parts of a right pixel, and steps enough for comparisons in a row."""


KINDS = ("numbers", "fractions")
FRACTION = data.StructLayout({"num": range(-8, 13), "den": range(5)})


def drawn(kind: str, rng: np.random.Generator, shape: tuple[int, ...], most: int) -> np.ndarray:
    """Costs as the gateware takes them, numerator and denominator; of fractions some are infinite."""
    if kind == "numbers":
        return np.stack((rng.integers(0, most, shape), np.zeros(shape, int)), axis=-1)
    costs = np.stack((rng.integers(-8, 13, shape), rng.integers(0, 5, shape)), axis=-1)
    costs[costs[..., 1] == 0] = 1, 0
    return costs


def value(cost: np.ndarray, kind: str) -> Fraction | float:
    """What a cost is worth."""
    num, den = map(int, cost)
    if kind == "numbers":
        return Fraction(num)
    return Fraction(num, den) if den else float("inf")


def of_step(volume: np.ndarray, lanes: int, steps: int, step: int) -> list[int]:
    """What each lane judges in a step, of a pixel's candidates."""
    return [int(volume[lane * steps + steps - 1 - step]) for lane in range(lanes)]


def costs_of_step(costs: np.ndarray, lanes: int, steps: int, step: int) -> list[dict[str, int]]:
    """The same of costs."""
    num, den = (of_step(costs[:, part], lanes, steps, step) for part in (0, 1))
    return [{"num": n, "den": d} for n, d in zip(num, den, strict=True)]


def bits_of(flags: list[int]) -> int:
    return sum(flag << k for k, flag in enumerate(flags))


@pytest.mark.parametrize(("lanes", "steps"), RIGHT_GEOMETRIES)
@pytest.mark.parametrize("width", [4, 19])
@pytest.mark.parametrize("kind", KINDS)
def test_right_winner(lanes: int, steps: int, width: int, kind: str) -> None:
    rng = np.random.default_rng(lanes)
    count = lanes * steps
    lines = drawn(kind, rng, (4, width, count), 12)
    clocks, slots = [], []
    for line in [*lines, np.zeros((count, count, 2), int)]:
        drained = len(line) == count and line.sum() == 0
        for x, costs in enumerate(line):
            slots.append(len(clocks))
            excluded = np.ones(count, int) if drained else (np.arange(count) > x).astype(int)
            for step in range(steps):
                clocks.append(
                    {
                        "valid": 1,
                        "first": step == 0,
                        "last": step == steps - 1,
                        "step": step,
                        "costs": costs_of_step(costs, lanes, steps, step),
                        "excluded": bits_of(of_step(excluded, lanes, steps, step)),
                    }
                )
            # Slots follow each other at once or do not.
            clocks += [{"valid": 0, "first": 0, "last": 0}] * int(rng.integers(9) * (rng.random() < 0.2))
    layout = FRACTION if kind == "fractions" else sum_layout(11)
    dut = right_winner(lanes, steps, layout)
    found = observe(dut, [*clocks, *[{"valid": 0, "first": 0}] * dut.latency], "winner")
    for number, line in enumerate(lines):
        for right in range(width):
            costs = [value(line[right + d, d], kind) for d in range(count) if right + d < width]
            slot = number * width + right + count - 1
            assert found[slots[slot] + dut.latency] == costs.index(min(costs)), (number, right)


@pytest.mark.parametrize(("lanes", "steps"), GEOMETRIES)
@pytest.mark.parametrize("kind", KINDS)
def test_neighbours(lanes: int, steps: int, kind: str) -> None:
    rng = np.random.default_rng(steps)
    count, pixels = lanes * steps, 40
    layout = FRACTION if kind == "fractions" else sum_layout(99)
    dut = Neighbours(lanes, steps, layout)
    costs = drawn(kind, rng, (pixels, count), 100)
    worth = [[value(cost, kind) for cost in of_pixel] for of_pixel in costs]
    excluded = (np.arange(count) >= rng.integers(1, count + 3, pixels)[:, None]).astype(int)
    winners = [
        min((w, d) for d, w in enumerate(of_pixel) if not out[d])[1]
        for of_pixel, out in zip(worth, excluded, strict=True)
    ]
    clocks: list[dict] = [{} for _ in range(pixels * steps + dut.latency + 1)]
    for k in range(pixels):
        for step in range(steps):
            at = k * steps + step
            clocks[at] |= {
                "valid": 1,
                "first": step == 0,
                "last": step == steps - 1,
                "step": step,
                "winner": winners[k],
            }
            clocks[at + Neighbours.costs_late] |= {
                "costs": costs_of_step(costs[k], lanes, steps, step),
                "excluded": bits_of(of_step(excluded[k], lanes, steps, step)),
            }

    def given(name: str) -> list[Fraction | float]:
        costs = [layout.from_bits(bits) for bits in observe(dut, clocks, name)]
        return [value(np.array((cost.num, cost.den)), kind) for cost in costs]

    for name in ("below", "above"):
        seen = given(name)
        has = observe(dut, clocks, f"has_{name}")
        for k, winner in enumerate(winners):
            beside = winner + (1 if name == "above" else -1)
            there = 0 <= beside < count and not excluded[k, beside]
            at = (k + 1) * steps - 1 + dut.latency
            assert has[at] == there
            if there:
                assert seen[at] == worth[k][beside]
    seen, has = given("runner_up"), observe(dut, clocks, "has_runner_up")
    for k, winner in enumerate(winners):
        far = [worth[k][d] for d in range(count) if abs(d - winner) > 1 and not excluded[k, d]]
        at = (k + 1) * steps - 1 + dut.latency
        assert has[at] == bool(far)
        if far:
            assert seen[at] == min(far)


def test_numbers_of_fractions() -> None:
    """Every small fraction, those that the range cuts off, and what has no denominator."""
    low, high = Config.preset("paper").number_range
    layout = data.StructLayout({"num": range(-200, 200), "den": range(40)})
    fractions = [(n, d) for n in range(-40, 41) for d in (1, 2, 3, 7, 39)] + [(1, 0), (-200, 1), (199, 1)]
    expected = [
        min(max((n << QUOTIENT_BITS) // d, low), high) - low if d else high - low for n, d in fractions
    ]
    assert {0, high - low} < set(expected)
    assert piped(Number(layout, low, high), [{"i": {"num": n, "den": d}} for n, d in fractions]) == expected


def test_sixteenths_are_exact() -> None:
    """Every triple of small costs, and random large ones."""
    triples = [(a, b, c) for c in range(7) for a in range(c, 7) for b in range(c, 7)]
    rng = np.random.default_rng(2)
    large = np.sort(rng.integers(0, 1 << 11, (300, 3)))
    triples += [(int(a), int(b), int(c)) for c, a, b in large] + [
        (int(b), int(a), int(c)) for c, a, b in large
    ]
    inputs = [
        {"winner": k % 62 + 1, "cost": c, "below": a, "above": b, "usable": k % 9 > 0}
        for k, (a, b, c) in enumerate(triples)
    ]
    expected = []
    for given, (a, b, c) in zip(inputs, triples, strict=True):
        slope = max(a, b) - c
        moved = (16 * (a - b) + slope) // (2 * slope) if slope and given["usable"] else 0
        expected.append(16 * given["winner"] + moved)
    assert piped(Sixteenths(64, 11), inputs) == expected


@pytest.mark.parametrize("shift", [0, 2])
def test_confidence(shift: int) -> None:
    rng = np.random.default_rng(shift)
    inputs = [
        {"cost": int(c), "runner_up": int(c + m), "has_runner_up": int(h)}
        for c, m, h in zip(*rng.integers(0, [[400], [600], [2]], (3, 200)), strict=True)
    ]
    expected = [min(255, (i["runner_up"] - i["cost"]) >> shift) if i["has_runner_up"] else 0 for i in inputs]
    assert piped(Confidence(10, shift), inputs) == expected


@pytest.mark.parametrize(("disparities", "tolerance"), [(8, 0), (5, 1), (20, 0)])
def test_left_right(disparities: int, tolerance: int) -> None:
    """Slots of lines and of what lies between them, some clocks apart."""
    rng = np.random.default_rng(disparities)
    slots = 120
    left = rng.integers(0, disparities, slots)
    right = rng.integers(0, disparities, slots)  # by its own slot
    emits = rng.integers(0, 2, slots)
    # What is not the slot's in its clock is something else.
    clocks = []
    for k in range(slots):
        late = right[k - disparities + 1] if k >= disparities - 1 else 0
        clocks.append({"valid": 1, "winner": int(left[k]), "right": int(late)})
        pause = int(rng.integers(3)) if k < slots // 2 else 0
        clocks += [{"valid": 0, "winner": 1, "right": 2}] * pause
    starts = [k for k, clock in enumerate(clocks) if clock["valid"]]
    clocks += [{"valid": 0}] * (LeftRight.lead + LeftRight.latency)
    clocks = [{**clock, "emits": 1, "result": 255} for clock in clocks]
    for k, start in enumerate(starts):
        clocks[start + LeftRight.lead] |= {"emits": int(emits[k]), "result": k}
    dut = LeftRight(disparities, 8, tolerance)
    seen = {name: observe(dut, clocks, name) for name in ("done", "o_emits", "agrees", "o")}
    assert sum(seen["done"]) == slots
    judged = iter(k for k, done in enumerate(seen["done"]) if done)
    for slot in range(-disparities + 1, slots - disparities + 1):
        at = next(judged)
        assert seen["o_emits"][at] == (slot >= 0 and emits[slot])
        if slot >= 0 and emits[slot] and slot >= left[slot]:
            assert seen["o"][at] == slot
            assert seen["agrees"][at] == (abs(int(right[slot - left[slot]]) - int(left[slot])) <= tolerance)
