"""Island test, filling and medians, each against plain loops, frames of all sizes back to back."""

import numpy as np
import pytest

from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.masked_medians import MaskedMedians
from softdepth.hdl.post.median import Median
from softdepth.hdl.post.rank import LowerMedian
from tests.support.results import (
    CHANNELS,
    COLOUR_BITS,
    MAX_WIDTH,
    VALUE_BITS,
    Fields,
    check,
    random_fields,
    through,
)
from tests.support.simulation import piped

SIZES = [(4, 7), (1, 4), (6, 5), (3, MAX_WIDTH), (2, 4)]
STALLS = [{}, {"i_rate": 0.6, "o_rate": 0.4, "seed": 3}]


def frames(seed: int) -> list[Fields]:
    rng = np.random.default_rng(seed)
    return [
        random_fields(rng, *size, measured=m) for size, m in zip(SIZES, (0.6, 0.9, 0.1, 0.3, 0), strict=True)
    ]


@pytest.mark.parametrize("stalls", STALLS)
@pytest.mark.parametrize(
    ("least", "rows", "columns", "clocks"),
    [(8, 2, 2, 1), (14, 2, 2, 2), (8, 1, 4, 2), (3, 0, 2, 1), (2, 1, 0, 2), (2, 0, 0, 1)],
)
def test_island(least: int, rows: int, columns: int, clocks: int, stalls: dict[str, float]) -> None:
    sent = frames(1)
    expected = []
    for frame in sent:
        height, width = frame["value"].shape
        want = {name: values.copy() for name, values in frame.items()}
        for y in range(height):
            for x in range(width):
                count = 0
                for dy in range(-rows, rows + 1):
                    for dx in range(-columns, columns + 1):
                        near = min(max(y + dy, 0), height - 1), min(max(x + dx, 0), width - 1)
                        count += frame["code"][near] < 2
                if frame["code"][y, x] < 2 and count < least:
                    want["value"][y, x], want["code"][y, x], want["confidence"][y, x] = 0, 5, 0
        expected.append(want)
    assert any((want["code"] != frame["code"]).any() for want, frame in zip(expected, sent, strict=True))
    dut = Island(VALUE_BITS, COLOUR_BITS, MAX_WIDTH, least, rows=rows, columns=columns, clocks=clocks)
    check(through(dut, sent, **stalls), expected)


@pytest.mark.parametrize("stalls", STALLS)
def test_fill(stalls: dict[str, float]) -> None:
    sent = frames(2)
    expected = []
    for frame in sent:
        height, width = frame["value"].shape
        want = {name: values.copy() for name, values in frame.items()}
        for y in range(height):
            measured = [x for x in range(width) if frame["code"][y, x] < 2]
            for x in set(range(width)) - set(measured):
                left = [frame["value"][y, k] for k in measured if k < x][-1:]
                right = [frame["value"][y, k] for k in measured if k > x][:1]
                want["value"][y, x] = min(left + right, default=0)
                want["code"][y, x] = 3 if measured else 6
                want["confidence"][y, x] = 0
        expected.append(want)
    codes = {int(code) for want in expected for code in np.unique(want["code"])}
    assert codes == {0, 1, 3, 6}
    check(through(Fill(VALUE_BITS, COLOUR_BITS, MAX_WIDTH), sent, **stalls), expected)


@pytest.mark.parametrize("stalls", STALLS)
@pytest.mark.parametrize(("rows", "columns", "holes"), [(2, 2, False), (1, 1, True), (1, 2, True)])
def test_median(rows: int, columns: int, holes: bool, stalls: dict[str, float]) -> None:
    sent = frames(3)
    expected = [medians(frame, rows, columns, None, holes) for frame in sent]
    dut = Median(VALUE_BITS, COLOUR_BITS, MAX_WIDTH, rows=rows, columns=columns, holes=holes)
    check(through(dut, sent, **stalls), expected)


@pytest.mark.parametrize("stalls", STALLS)
@pytest.mark.parametrize(
    ("rows", "columns", "spacing", "like", "holes", "clocks"),
    [
        (9, 9, 1, 4, False, 2),
        (2, 2, 1, 4, True, 1),
        (3, 3, 1, 3, True, 2),
        (1, 1, 1, 4, False, 1),
        (3, 8, 2, 4, False, 2),
        (4, 3, 2, 4, True, 1),
        (1, 5, 1, 4, True, 2),
        (5, 7, 3, 3, False, 1),
        (4, 3, 2, 4, True, 2),
        (3, 7, 3, 3, False, 2),
    ],
)
def test_masked_medians(
    rows: int, columns: int, spacing: int, like: int, holes: bool, clocks: int, stalls: dict[str, float]
) -> None:
    sent = frames(4)
    expected = []
    for frame in sent:
        along = medians(frame, 0, columns, like, holes, spacing)
        expected.append(medians(along, rows, 0, like, holes) | {"colour": 0 * frame["colour"]})
    dut = MaskedMedians(
        *(VALUE_BITS, COLOUR_BITS, CHANNELS, MAX_WIDTH),
        **{"rows": rows, "columns": columns, "spacing": spacing},
        **{"like": like, "holes": holes, "clocks": clocks},
    )
    check(through(dut, sent, patience=1000, **stalls), expected)


def medians(
    frame: Fields, rows: int, columns: int, like: int | None, holes: bool, spacing: int = 1
) -> Fields:
    """A frame whose values are medians; only with ``like`` what lies outside is left out."""
    height, width = frame["value"].shape
    want = {name: values.copy() for name, values in frame.items()}
    colours = frame["colour"][..., None] >> np.array([0, 4, 8]) & 15
    for y in range(height):
        for x in range(width):
            kept = []
            for near_y in range(y - rows, y + rows + 1):
                for near_x in range(x - columns // spacing * spacing, x + columns + 1, spacing):
                    inside = 0 <= near_y < height and 0 <= near_x < width
                    ny, nx = min(max(near_y, 0), height - 1), min(max(near_x, 0), width - 1)
                    is_like = like is None or (
                        inside and np.abs(colours[ny, nx] - colours[y, x]).max() < like
                    )
                    if is_like and not (holes and frame["code"][ny, nx] >= 2):
                        kept.append(frame["value"][ny, nx])
            if not (holes and frame["code"][y, x] >= 2):
                want["value"][y, x] = sorted(kept)[(len(kept) - 1) // 2]
    return want


@pytest.mark.parametrize(("samples", "bits"), [(25, 10), (19, 4), (3, 1), (1, 3)])
def test_lower_median(samples: int, bits: int) -> None:
    rng = np.random.default_rng(samples)
    sets = []
    for spread in [1, 2, 2**bits] * 20:
        base = rng.integers(0, 2**bits - spread + 1)
        sets.append((base + rng.integers(0, spread, samples), int(rng.integers(1, 2**samples))))
    sets.append((np.zeros(samples, int), 1))
    sets.append((np.full(samples, 2**bits - 1), 2**samples - 1))
    inputs = [{"i": [int(v) for v in values], "keep": keep} for values, keep in sets]
    expected = []
    for values, keep in sets:
        kept = sorted(int(v) for k, v in enumerate(values) if keep >> k & 1)
        expected.append(kept[(len(kept) - 1) // 2])
    assert piped(LowerMedian(samples, bits), inputs) == expected
    everything = LowerMedian(samples, bits, all_kept=True)
    found = piped(everything, [{"i": given["i"]} for given in inputs])
    assert found == [sorted(values.tolist())[(samples - 1) // 2] for values, _ in sets]
