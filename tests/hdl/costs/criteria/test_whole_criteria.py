"""Blocks of the criteria without a border band, each against plain sums."""

import numpy as np
import pytest
from amaranth.hdl import Shape

from softdepth.hdl.costs.criteria.column_sum import ColumnSum
from softdepth.hdl.costs.criteria.row_box import RowBox
from softdepth.hdl.costs.criteria.row_sum import RowSum
from softdepth.hdl.costs.criteria.running_sums import RunningSums
from softdepth.hdl.costs.criteria.support import SupportMean, SupportWeights
from softdepth.hdl.costs.criteria.unlikeness import ColourDifference, GradientDifference, Hamming
from tests.support.simulation import observe


def delayed_flags(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    return rng.integers(0, 2, count), rng.integers(0, 4, count) > 0


@pytest.mark.parametrize(("bits", "neutral"), [(24, 6), (5, 3), (1, 0)])
def test_hamming(bits: int, neutral: int) -> None:
    rng = np.random.default_rng(bits)
    a, b = rng.integers(0, 2**bits, (2, 60))
    absent, inside = delayed_flags(rng, 60)
    clocks = [{"a": int(a[k]), "b": int(b[k])} for k in range(60)] + [{}, {}]
    for k in range(60):
        clocks[k + 1] |= {"absent": int(absent[k]), "inside": int(inside[k])}
    expected = [
        (neutral if absent[k] else (int(a[k]) ^ int(b[k])).bit_count()) if inside[k] else 0 for k in range(60)
    ]
    assert observe(Hamming(bits, neutral), clocks, "o")[2:] == expected


@pytest.mark.parametrize(("cap", "truncation", "neutral"), [(31, 16, 2), (7, 40, 3), (2, 1, 1), (1, 40, 9)])
def test_gradient_difference(cap: int, truncation: int, neutral: int) -> None:
    rng = np.random.default_rng(cap)
    a, b = rng.integers(-cap, cap + 1, (2, 80))
    absent, inside = delayed_flags(rng, 80)
    clocks = [{"a": int(a[k]), "b": int(b[k])} for k in range(80)] + [{}, {}]
    for k in range(80):
        clocks[k + 1] |= {"absent": int(absent[k]), "inside": int(inside[k])}
    expected = [
        (neutral if absent[k] else min(abs(int(a[k] - b[k])), truncation)) if inside[k] else 0
        for k in range(80)
    ]
    shape = Shape.cast(range(-cap, cap + 1))
    assert observe(GradientDifference(shape, 2 * cap, truncation, neutral), clocks, "o")[2:] == expected


@pytest.mark.parametrize(("channels", "bits"), [(3, 8), (1, 12)])
def test_colour_difference(channels: int, bits: int) -> None:
    rng = np.random.default_rng(bits)
    a, b = rng.integers(0, 1 << bits, (2, 80, channels))
    a[0], b[0] = 0, (1 << bits) - 1
    absent, inside = delayed_flags(rng, 80)
    absent[0], inside[0] = 0, 1

    def packed(pixel: np.ndarray) -> int:
        return sum(int(v) << bits * k for k, v in enumerate(pixel))

    clocks = [{"a": packed(a[k]), "b": packed(b[k])} for k in range(80)] + [{}, {}]
    for k in range(80):
        clocks[k + 1] |= {"absent": int(absent[k]), "inside": int(inside[k])}
    expected = [0 if absent[k] or not inside[k] else int(abs(a[k] - b[k]).sum()) for k in range(80)]
    assert observe(ColourDifference(channels, bits), clocks, "o")[2:] == expected


@pytest.mark.parametrize(("columns", "steps"), [(9, 2), (7, 1), (15, 4)])
def test_row_sum(columns: int, steps: int) -> None:
    """Of lines of all lengths, with pauses between steps."""
    rng = np.random.default_rng(columns)
    maximum, expected, clocks = 144, {}, []
    dut = RowSum(maximum, columns, steps)
    for width in (columns, 3, 2 * columns + 1):
        line = rng.integers(0, maximum + 1, (width, steps))
        for x, step in np.ndindex(line.shape):
            clocks += [{"valid": 0, "column": int(rng.integers(maximum))}] * int(rng.integers(3))
            expected[len(clocks)] = int(line[max(x - columns + 1, 0) : x + 1, step].sum())
            full = x >= columns
            leaving = int(line[x - columns, step]) if full else int(rng.integers(maximum))
            clocks.append(
                {"valid": 1, "column": int(line[x, step]), "leaving": leaving, "begins": x == 0, "full": full}
            )
    found = observe(dut, [*clocks, {"valid": 0}, {}], "o")
    assert {k: found[k + dut.latency] for k in expected} == expected


@pytest.mark.parametrize(("maximum", "rows"), [(16, 9), (24, 15), (1, 2), (5, 1), (3, 7)])
def test_column_sum(maximum: int, rows: int) -> None:
    rng = np.random.default_rng(rows)
    columns = np.vstack([np.full((1, rows), maximum), rng.integers(0, maximum + 1, (60, rows))])
    clocks = [{"i": column.tolist()} for column in columns]
    found = observe(ColumnSum(maximum, rows), [*clocks, {}, {}], "o")[ColumnSum.latency :]
    assert found[: len(columns)] == columns.sum(axis=1).tolist()


def test_running_sums_begin_from_0_on_each_frame() -> None:
    """Two frames of 7 rows, windows of 3; a column of the line lies outside."""
    rng = np.random.default_rng(5)
    columns, rows, window = 8, 7, 3
    clocks: list[dict[str, int]] = []
    expected = []
    for _ in range(2):
        values = rng.integers(0, 16, (rows, columns, 2))
        for y in range(rows):
            for x in range(columns):
                old = values[y - window, x] if y >= window else (0, 0)
                pack = [int(v[0]) | int(v[1]) << 4 for v in (values[y, x], old)]
                outside = x == columns - 1
                clocks.append(
                    {"valid": 1, "place": x, "begins": y == 0, "outside": outside, "late": tuple(pack)}
                )
                total = values[max(y - window + 1, 0) : y + 1, x].sum(0)
                expected.append(0 if outside else int(total[0]) | int(total[1]) << 6)
    late = [clock.pop("late") for clock in clocks]
    clocks += [{"valid": 0}] * RunningSums.latency
    for k, (new, old) in enumerate(late):
        clocks[k + RunningSums.ahead] = clocks[k + RunningSums.ahead] | {"new": new, "old": old}
    dut = RunningSums([63, 63], [15, 15], columns)
    driven = []
    for clock in clocks:
        values = dict(clock)
        for name in ("new", "old"):
            if name in values:
                values[name] = {"0": values[name] & 15, "1": values[name] >> 4}
        driven.append(values)
    found = observe(dut, driven, "o")[RunningSums.latency :]
    assert found == expected


@pytest.mark.parametrize(("columns", "lag", "steps"), [(5, 3, 2), (9, 0, 1), (1, 4, 3), (3, 2, 1)])
def test_row_box(columns: int, lag: int, steps: int) -> None:
    rng = np.random.default_rng(columns)
    dut = RowBox(80, columns, lag, steps)
    values = rng.integers(0, 81, 60 * steps)
    clocks = []
    for value in values:  # every third clock is idle, between slots and within them
        clocks += [{"valid": 1, "column": int(value)}, {"valid": 1, "column": int(value)}][:1]
    found = observe(dut, [*clocks, *[{"valid": 0}] * dut.latency], "o")[dut.latency :]
    for k in range((columns + lag) * steps, len(values)):
        assert found[k] == sum(values[k - (lag + j) * steps] for j in range(columns)), k


@pytest.mark.parametrize(("taps", "spacing", "steps"), [(7, 4, 2), (3, 1, 1), (5, 2, 3)])
def test_support(taps: int, spacing: int, steps: int) -> None:
    """Weights of a line between columns outside it, and the mean of column sums by any weights."""
    rng = np.random.default_rng(taps)
    like, width, reach = 5, 40, taps // 2 * spacing
    weights = SupportWeights(12, 3, taps, spacing, like)
    colours = rng.integers(0, 2, (width, 1)) * 6 + rng.integers(0, 6, (width, 3))
    slots = (
        [(0, 0)] * reach + [(int((c << np.array([0, 4, 8])).sum()), 1) for c in colours] + [(0, 0)] * reach
    )
    clocks = [{"enters": 1, "colour": c, "inside": i} for c, i in slots]
    clocks += [{"enters": 0}] * weights.latency
    found = observe(weights, clocks, "weights")[weights.latency + 2 * reach :]
    scales = observe(weights, clocks, "reciprocal")[weights.latency + 2 * reach :]
    for x in range(width):
        expected = []
        for k in range(taps):
            near = x + (k - taps // 2) * spacing
            inside = 0 <= near < width
            expected.append(int(inside and np.abs(colours[near] - colours[x]).max() < like))
        assert [found[x] >> k & 1 for k in range(taps)] == expected, x
        assert scales[x] == (8192 // sum(expected) + 1) // 2

    mean = SupportMean(216, taps, spacing, steps)
    values = rng.integers(0, 217, 200)
    masks = rng.integers(1, 2**taps, 200)
    counts = [int(mask).bit_count() for mask in masks]
    inputs = [
        {"valid": 1, "column": int(v), "weights": int(w), "reciprocal": (8192 // n + 1) // 2}
        for v, w, n in zip(values, masks, counts, strict=True)
    ]
    out = observe(mean, [*inputs, *[{"valid": 0}] * mean.latency], "o")[mean.latency :]
    gap = spacing * steps
    for k in range((taps - 1) * gap, len(values)):
        kept = [int(values[k - (taps - 1 - j) * gap]) for j in range(taps) if masks[k] >> j & 1]
        assert out[k] == sum(kept) * ((8192 // len(kept) + 1) // 2) >> 10, k
