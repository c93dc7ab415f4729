"""Census, gradient, winners and post-processing against plain loops over their definitions."""

import itertools
import math

import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.data.pair import StereoPair
from softdepth.spec.config import Config
from softdepth.studies.evaluate.variants import ABLATIONS
from tests.golden.test_fixed_model_loops import loop_inference
from tests.golden.test_float_model import eq_10

FULL, PARTIAL, FILLED, INCONSISTENT, ISLAND, NOTHING = 0, 1, 3, 4, 5, 6


def clip(value, low, high):
    return max(low, min(high, value))


class Loops:
    """The method, one pixel at a time; Python integers only."""

    def __init__(self, left, right, config):
        self.c = config
        self.h, self.w = left.shape[:2]
        self.colour = left.reshape(self.h, self.w, -1).tolist()
        self.luma = [self.luma_of(view.reshape(self.h, self.w, -1).tolist()) for view in (left, right)]

    def luma_of(self, view):
        return [[p[0] if len(p) == 1 else (p[0] + 2 * p[1] + p[2]) // 4 for p in row] for row in view]

    def at(self, view, y, x):
        return self.luma[view][clip(y, 0, self.h - 1)][clip(x, 0, self.w - 1)]

    def darker(self, view, y, x):
        """Which neighbours are darker than the centre; every second one of the 7x7."""
        places = [(i, j) for i in range(7) for j in range(7) if (i + j) % 2 == 0 and (i, j) != (3, 3)]
        return [self.at(view, y + i - 3, x + j - 3) < self.at(view, y, x) for i, j in places]

    def slope(self, view, y, x, cap):
        total = 0
        for dy, weight in ((-1, 1), (0, 2), (1, 1)):
            total += weight * (self.at(view, y + dy, x + 1) - self.at(view, y + dy, x - 1))
        return clip(total, -cap, cap)

    def alike(self, y, x, y2, x2, like, bits=8):
        if not (0 <= y2 < self.h and 0 <= x2 < self.w):
            return False
        unit = 2 ** max(8 - bits, 0)
        pairs = zip(self.colour[y][x], self.colour[y2][x2], strict=True)
        return all(unit * abs(a // unit - b // unit) < like for a, b in pairs)

    def inside(self, y, x):
        return 0 <= y < self.h and 0 <= x < self.w

    def hamming(self, c, y, x, d):
        if not self.inside(y, x):
            return 0
        if x < d:
            return c.neutral
        return sum(a != b for a, b in zip(self.darker(0, y, x), self.darker(1, y, x - d), strict=True))

    def census(self, c, y, x, d):
        places = [x + c.spacing * k for k in range(-(c.taps // 2), c.taps // 2 + 1)]
        places = [p for p in places if self.alike(y, x, y, p, c.like)]
        half = c.rows // 2
        total = sum(self.hamming(c, y + k, p, d) for p in places for k in range(-half, half + 1))
        return total * ((8192 // len(places) + 1) // 2) // 1024

    def gradient(self, c, y, x, d):
        total = 0
        for i in range(y - c.rows // 2, y + c.rows // 2 + 1):
            for j in range(x - c.columns // 2, x + c.columns // 2 + 1):
                if not self.inside(i, j):
                    continue
                if j < d:
                    total += c.neutral
                else:
                    difference = abs(self.slope(0, i, j, c.cap) - self.slope(1, i, j - d, c.cap))
                    total += min(difference, c.truncation)
        return total

    def cost(self, y, x, d):
        return sum(getattr(self, c.kind)(c, y, x, d) for c in self.c.criteria)

    def number(self, cost):
        """A cost as fractions of a pixel and confidence take it."""
        return cost

    def result(self):
        post, count = self.c.post, self.c.disparities
        rows, columns = range(self.h), range(self.w)
        cost = {(y, x, d): self.cost(y, x, d) for y in rows for x in columns for d in range(count) if d <= x}
        pixels = [(y, x) for y in rows for x in columns]
        number = {place: self.number(one) for place, one in cost.items()}
        left = {(y, x): min((cost[y, x, d], d) for d in range(min(count, x + 1)))[1] for y, x in pixels}
        right = {
            (y, x): min((cost[y, x + d, d], d) for d in range(count) if x + d < self.w)[1] for y, x in pixels
        }
        code = {(y, x): FULL if x >= count - 1 else PARTIAL for y, x in pixels}
        value, sure = {}, {}
        for y, x in pixels:
            d = left[y, x]
            value[y, x] = 16 * d
            if 0 < d < count - 1 and d + 1 <= x:
                a, c, b = (number[y, x, d + k] for k in (-1, 0, 1))
                if max(a, b) > c:
                    value[y, x] += (16 * (a - b) + max(a, b) - c) // (2 * (max(a, b) - c))
            others = [number[y, x, e] for e in range(min(count, x + 1)) if abs(e - d) > 1]
            margin = min(others) - number[y, x, d] if others else 0
            sure[y, x] = min(255, margin >> self.c.confidence_shift)
            if abs(right[y, x - d] - d) > post.tolerance:
                code[y, x] = INCONSISTENT
        valid = {p for p in pixels if code[p] <= PARTIAL}
        for y, x in sorted(valid):
            around = self.around(y, x, post.island_rows, post.island_columns)
            if sum(p in valid for p in around) < post.island:
                code[y, x] = ISLAND
        valid = {p for p in pixels if code[p] <= PARTIAL}
        value = {p: value[p] if p in valid else 0 for p in pixels}
        if post.fill:
            value = {p: value[p] if p in valid else self.filler(p, value, valid) for p in pixels}
            for y, x in pixels:
                if (y, x) not in valid:
                    code[y, x] = FILLED if any((y, j) in valid for j in columns) else NOTHING
        taking = set(pixels) if post.fill else valid
        if post.median:
            value = {p: self.median(p, value, taking) if p in taking else 0 for p in pixels}
        for dy, dx in ((0, 1), (1, 0)) if post.masked_median else ():
            value = {p: self.masked(p, value, taking, dy, dx) if p in taking else 0 for p in pixels}
        return value, code, {p: sure[p] if p in valid else 0 for p in pixels}

    def around(self, y, x, rows, columns):
        steps = itertools.product(range(rows), range(columns))
        top, first = y - rows // 2, x - columns // 2
        return [(clip(top + i, 0, self.h - 1), clip(first + j, 0, self.w - 1)) for i, j in steps]

    def filler(self, p, value, valid):
        y, x = p
        found = []
        for step in (-1, 1):
            j = x
            while 0 <= j < self.w and (y, j) not in valid:
                j += step
            if 0 <= j < self.w:
                found.append(value[y, j])
        return min(found, default=0)

    def median(self, p, value, taking):
        y, x = p
        found = sorted(value[q] for q in self.around(y, x, 5, 5) if q in taking)
        return found[(len(found) - 1) // 2]

    def masked(self, p, value, taking, dy, dx):
        y, x = p
        post = self.c.post
        reach = post.masked_median if dx else min(post.masked_median, post.masked_rows)
        steps = [k for k in range(-reach, reach + 1) if not dx or k % min(post.masked_spacing, reach) == 0]
        places = [(y + k * dy, x + k * dx) for k in steps]
        places = [q for q in places if self.alike(y, x, *q, post.like, post.colour_bits) and q in taking]
        found = sorted(value[q] for q in places)
        return found[(len(found) - 1) // 2]


class FuzzyLoops(Loops):
    """The same with fuzzy inference over the criteria: costs are fractions, compared exactly."""

    def cost(self, y, x, d):
        return loop_inference([getattr(self, c.kind)(c, y, x, d) for c in self.c.criteria], self.c)

    def number(self, cost):
        return math.floor(64 * cost)


def frames(height, width, seed):
    """Textured patches that move by three, with noise: every stage has something to do."""
    random = np.random.default_rng(seed)
    scene = np.kron(random.integers(0, 256, (height, width + 3, 3)), np.ones((1, 1, 1))).astype(np.uint8)
    scene[: height // 2] = scene[: height // 2] // 64 * 64
    left, right = scene[:, :width].copy(), scene[:, 3:].copy()
    right[:, width // 2 :] = random.integers(0, 256, right[:, width // 2 :].shape)
    return left, right


CASES = {
    "robust": ("robust", []),
    "small": ("robust-small", []),
    "gray": ("robust-gray", []),
    "left invalid": ("robust", ["post.fill=false", "post.island=16"]),
    "tolerant": ("robust", ["post.tolerance=1", "post.island=3"]),
    "odd sizes": (
        "robust",
        [
            "criteria.0.rows=3", "criteria.0.taps=3", "criteria.0.spacing=1", "criteria.0.neutral=11",
            "criteria.1.rows=3", "criteria.1.columns=7", "criteria.1.truncation=40", "post.masked_median=2",
        ],
    ),
    "small, nothing saved": ("robust-small", ABLATIONS["all of these"]),
    "coarse colours": ("robust", ["post.colour_bits=3", "post.like=40", "post.island_columns=3"]),
    "far apart": ("robust-gray", ["post.masked_median=6", "post.masked_spacing=3", "post.masked_rows=1"]),
    "no support": ("robust", ["criteria.0.taps=1", "post.median=0"]),
}  # fmt: skip


@pytest.mark.parametrize("size", [(6, 11), (3, 4)])
@pytest.mark.parametrize("case", CASES)
def test_every_pixel_code_and_confidence(case, size):
    preset, changes = CASES[case]
    config = Config.preset(preset).override(["disparities=6", "lanes=6", *changes])
    pair = StereoPair(*frames(*size, seed=len(case)), case).as_format(config.pixel)
    got = fixed_model.disparity(pair.left, pair.right, config)
    value, code, sure = Loops(pair.left, pair.right, config).result()
    for (y, x), expected in value.items():
        assert got.at(x, y) == (expected, code[y, x], sure[y, x]), (y, x)


@pytest.mark.parametrize("operator", ["mean", "min", "soft_min_1"])
def test_fuzzy_costs_with_fractions_and_confidence(operator):
    config = fuzzy_config(operator)
    left, right = frames(6, 11, seed=5)
    got = fixed_model.disparity(left, right, config)
    value, code, sure = FuzzyLoops(left, right, config).result()
    for (y, x), expected in value.items():
        assert got.at(x, y) == (expected, code[y, x], sure[y, x]), (y, x)
    assert any(v % 16 for v in value.values())
    assert len(set(sure.values())) > 3


@pytest.mark.parametrize("operator", ["mean", "prod", "soft_min_2"])
def test_the_float_model_of_fuzzy_costs(operator):
    """Labels at 2**label_bits of each criterion, and the paper's equations in floating point."""
    config = fuzzy_config(operator)
    left, right = frames(6, 11, seed=6)
    loops = Loops(left, right, config)
    for y, x in ((0, 0), (2, 4), (5, 10)):
        expected = []
        for d in range(min(6, x + 1)):
            found = [getattr(loops, c.kind)(c, y, x, d) / 2**c.label_bits for c in config.criteria]
            expected.append(eq_10(found, operator, label=1, delta=config.softness, k=config.sharpness))
        got = float_model.costs(left, right, config, x, y)
        np.testing.assert_allclose(got[: len(expected)], expected, rtol=1e-9)
        assert np.isinf(got[len(expected) :]).all()


def test_the_float_model_of_sums():
    config = Config.preset("robust").override(["disparities=6", "lanes=6"])
    left, right = frames(6, 11, seed=7)
    loops = Loops(left, right, config)
    for y, x in ((0, 3), (5, 10)):
        got = float_model.costs(left, right, config, x, y)
        assert got[: x + 1].tolist() == [loops.cost(y, x, d) for d in range(min(6, x + 1))]


def fuzzy_config(operator):
    """Census, gradient and gradient again, with labels in the range of so few rows."""
    small = [
        {"kind": "census", "rows": 3, "taps": 3, "spacing": 1, "label_bits": 6},
        {"kind": "gradient", "rows": 3, "columns": 3, "label_bits": 5},
        {"kind": "gradient", "rows": 5, "columns": 5, "label_bits": 7},
    ]
    config = Config.preset("robust").model_dump(mode="json")
    keys = {"cost": "fuzzy", "firing": "all", "rules": "printed", "operator": operator, "criteria": small}
    return Config.from_dict({**config, **keys, "disparities": 6, "lanes": 6, "membership_bits": 5})


def test_the_cases_reach_every_code():
    seen = set()
    for case, (preset, changes) in CASES.items():
        config = Config.preset(preset).override(["disparities=6", "lanes=6", *changes])
        pair = StereoPair(*frames(6, 11, seed=len(case)), case).as_format(config.pixel)
        seen |= set(fixed_model.disparity(pair.left, pair.right, config).code.ravel().tolist())
    assert {FULL, PARTIAL, FILLED, INCONSISTENT, ISLAND} <= seen


def test_trace_tells_each_stage():
    config = Config.preset("robust").override(["disparities=6", "lanes=6"])
    left, right = frames(6, 11, seed=1)
    stages = fixed_model.stages(left, right, config)
    for x, y in ((9, 1), (0, 5), (6, 3)):
        trace = fixed_model.trace(left, right, config, x, y, frame=stages)
        assert list(trace.stages) == list(stages.maps)
        assert trace.stages["winner"].disparity == trace.winner
        assert list(trace.stages.values())[-1] == stages.result.at(x, y)
        assert (trace.disparity, trace.code, trace.confidence) == stages.result.at(x, y)
        assert trace.around["at"] == trace.numerator[trace.winner]
        assert "after fill" in str(trace)


def test_a_row_without_a_result_has_nothing():
    """Noise against a flat view: with a strict island test nothing is left."""
    config = Config.preset("robust").override(["disparities=6", "lanes=6", "post.island=25"])
    left, _ = frames(5, 9, seed=3)
    right = np.random.default_rng(4).integers(0, 256, left.shape, dtype=np.uint8)
    found = fixed_model.disparity(left, right, config)
    assert (found.code == NOTHING).all()
    assert not found.disparity.any()
    assert not found.confidence.any()
