"""Right winners along the diagonal, neighbours and runner-up, sixteenths, confidence: against plain loops."""

import numpy as np
import pytest

from softdepth.hdl.post.confidence import Confidence
from softdepth.hdl.post.left_right import LeftRight
from softdepth.hdl.post.sixteenths import Sixteenths
from softdepth.hdl.winners.neighbours import Neighbours
from softdepth.hdl.winners.right_winner import RightWinner
from tests.support.simulation import observe, piped

GEOMETRIES = [(4, 2), (3, 1), (2, 3), (1, 4)]


def of_step(volume: np.ndarray, lanes: int, steps: int, step: int) -> list[int]:
    """What each lane judges in a step, of a pixel's candidates."""
    return [int(volume[lane * steps + steps - 1 - step]) for lane in range(lanes)]


def bits_of(flags: list[int]) -> int:
    return sum(flag << k for k, flag in enumerate(flags))


@pytest.mark.parametrize(("lanes", "steps"), GEOMETRIES)
@pytest.mark.parametrize("width", [4, 19])
def test_right_winner(lanes: int, steps: int, width: int) -> None:
    rng = np.random.default_rng(lanes)
    count = lanes * steps
    lines = rng.integers(0, 12, (4, width, count))
    clocks, slots = [], []
    for line in [*lines, np.zeros((count, count), int)]:
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
                        "costs": of_step(costs, lanes, steps, step),
                        "excluded": bits_of(of_step(excluded, lanes, steps, step)),
                    }
                )
        clocks += [{"valid": 0, "first": 0, "last": 0}] * 2
    found = observe(RightWinner(lanes, steps, 11), [*clocks, {}], "winner")
    for number, line in enumerate(lines):
        for right in range(width):
            costs = [line[right + d, d] for d in range(count) if right + d < width]
            slot = number * width + right + count - 1
            assert found[slots[slot] + 1] == int(np.argmin(costs)), (number, right)


@pytest.mark.parametrize(("lanes", "steps"), GEOMETRIES)
def test_neighbours(lanes: int, steps: int) -> None:
    rng = np.random.default_rng(steps)
    count, pixels = lanes * steps, 40
    dut = Neighbours(lanes, steps, 99)
    costs = rng.integers(0, 100, (pixels, count))
    excluded = (np.arange(count) >= rng.integers(1, count + 3, pixels)[:, None]).astype(int)
    winners = [int(np.argmin(np.where(e, 100, c))) for c, e in zip(costs, excluded, strict=True)]
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
                "costs": of_step(costs[k], lanes, steps, step),
                "excluded": bits_of(of_step(excluded[k], lanes, steps, step)),
            }
    for name in ("below", "above"):
        seen = observe(dut, clocks, name)
        has = observe(dut, clocks, f"has_{name}")
        for k, winner in enumerate(winners):
            beside = winner + (1 if name == "above" else -1)
            there = 0 <= beside < count and not excluded[k, beside]
            at = (k + 1) * steps - 1 + dut.latency
            assert has[at] == there
            if there:
                assert seen[at] == costs[k, beside]
    seen, has = observe(dut, clocks, "runner_up"), observe(dut, clocks, "has_runner_up")
    for k, winner in enumerate(winners):
        far = [costs[k, d] for d in range(count) if abs(d - winner) > 1 and not excluded[k, d]]
        at = (k + 1) * steps - 1 + dut.latency
        assert has[at] == bool(far)
        if far:
            assert seen[at] == min(far)


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
    clocks = []
    for k in range(slots):
        late = right[k - disparities + 1] if k >= disparities - 1 else 0
        clocks.append(
            {
                "valid": 1,
                "emits": int(emits[k]),
                "winner": int(left[k]),
                "result": k,
                "right": int(late),
            }
        )
        clocks += [{"valid": 0}] * int(rng.integers(3))
    clocks += [{"valid": 0}] * LeftRight.latency
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
