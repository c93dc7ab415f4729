"""The fixed model against plain loops over the paper's formulas, for many random configurations."""

import math
from fractions import Fraction

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.spec.config import OPERATORS, Config

# Table 1, transcribed from the paper: "31" is A_31, label 3 of criterion 1.
TABLE_1 = {
    1: ["31 32 33"],
    2: ["31 32 23", "31 22 33"],
    3: ["31 32 13", "31 22 23", "31 12 33"],
    4: ["31 12 13", "31 12 23", "31 22 13"],
    5: ["21 22 33", "21 32 23", "21 32 33"],
    6: ["21 12 33", "21 22 23", "21 32 13"],
    7: ["11 32 33", "21 12 23", "21 22 13"],
    8: ["11 22 33", "11 32 23", "21 12 13"],
    9: ["11 12 33", "11 22 23", "11 32 13"],
    10: ["11 12 23", "11 22 13"],
    11: ["11 12 13"],
}
CORRECTED = {**TABLE_1, 4: ["21 32 33", *TABLE_1[4][1:]], 5: [*TABLE_1[5][:2], "31 12 13"]}
BORDER, PARTIAL, FULL = 2, 1, 0


def loop_sad(left, right, x, y, d, window, dx):
    r = window // 2
    return sum(
        abs(left[y + m][x + dx + n][channel] - right[y + m][x + dx + n - d][channel])
        for m in range(-r, r + 1)
        for n in range(-r, r + 1)
        for channel in range(3)
    )


def loop_cost(left, right, x, y, d, c):
    s = [loop_sad(left, right, x, y, d, i.window, i.dx) for i in c.criteria]
    if c.cost == "sum":
        return Fraction(s[0])
    tops = [2 * 2**i.label_bits for i in c.criteria]
    rule = c.compensation
    if rule.reading != "off" and d >= rule.from_disparity:
        if rule.criterion == 0:
            assert any((i.window, i.dx) == (3, 0) for i in c.criteria)
            seen = loop_sad(left, right, x, y, d, 3, 0)
        else:
            seen = s[rule.criterion - 1]
        if seen > rule.threshold:
            s = tops if rule.reading == "top" else [1000] * 3
    return loop_inference(s, c)


def loop_inference(s, c):
    """N / S of three criteria's values."""
    tops = [2 * 2**i.label_bits for i in c.criteria]
    one = 2**c.membership_bits
    degree, cell = {}, set()
    for i, (value, top, criterion) in enumerate(zip(s, tops, c.criteria, strict=True), start=1):
        u = min(value, top) // 2 ** (criterion.label_bits - c.membership_bits)
        degree[f"1{i}"] = one - u if u < one else 0
        degree[f"2{i}"] = u if u < one else 2 * one - u
        degree[f"3{i}"] = u - one if u > one else 0
        cell |= {f"1{i}", f"2{i}"} if u < one else {f"2{i}", f"3{i}"}
    table = CORRECTED if c.rules == "corrected" else TABLE_1
    if c.firing == "cell":
        table = {k: [rule for rule in rules if set(rule.split()) <= cell] for k, rules in table.items()}
        assert sum(map(len, table.values())) == 8
    strengths = {k: loop_strength(rules, degree, c) if rules else 0 for k, rules in table.items()}
    total = sum(strengths.values())
    return Fraction(sum(y_k * (11 - k) for k, y_k in strengths.items()), total) if total > 0 else math.inf


def loop_strength(rules, degree, c):
    """The strongest of a conclusion's rules; `degree` is that of each label of each criterion."""
    if c.operator != "soft_min_2":
        triples = [[degree[label] for label in rule.split()] for rule in rules]
        return max(loop_theta(x, loop_theta(y, z, c), c) for x, y, z in triples)
    # Not monotone: rules that begin alike are joined first.
    pairs = {}
    for rule in rules:
        first, second, third = rule.split()
        pairs.setdefault(first, []).append(loop_theta(degree[second], degree[third], c))
    return max(loop_theta(degree[first], max(found), c) for first, found in pairs.items())


def loop_theta(a, b, c):
    """Equations 2 to 6 of two operands; the mean without its divisor. Rounding is to the nearest."""
    one = 2**c.membership_bits
    x, y = a / one, b / one
    match c.operator:
        case "min":
            return min(a, b)
        case "mean":
            return a + b
        case "prod":
            return (2 * a * b + one) // (2 * one)
        case "soft_min_1":
            delta = c.softness
            return round(one * (x + y + delta**2 - math.sqrt((x - y) ** 2 + delta**2)) / 2)
        case _:
            p, q = math.exp(-c.sharpness * x), math.exp(-c.sharpness * y)
            return round(one * (x * p + y * q) / (p + q))


def loop_model(left, right, c):
    """(disparity, code) of every pixel, straight from the rules; Python integers only."""
    a, b = left.tolist(), right.tolist()
    if c.reference == "right":
        a, b = [row[::-1] for row in b], [row[::-1] for row in a]
    height, width = len(a), len(a[0])
    offsets = [(i.window // 2, i.dx) for i in c.criteria]
    result = []
    for y in range(height):
        row = []
        for x in range(width):
            touched = {x} | {x + dx + s * r for r, dx in offsets for s in (-1, 1)}
            rows = {y + s * r for r, _ in offsets for s in (-1, 1)}
            if min(touched) < 0 or max(touched) >= width or min(rows) < 0 or max(rows) >= height:
                row.append((0, BORDER))
                continue
            allowed = [d for d in range(c.disparities) if min(touched) - d >= 0]
            best = min(allowed, key=lambda d: (loop_cost(a, b, x, y, d, c), d))
            row.append((best, FULL if len(allowed) == c.disparities else PARTIAL))
        result.append(row[::-1] if c.reference == "right" else row)
    return result


def random_config(rng):
    cost = rng.choice(["fuzzy", "fuzzy", "fuzzy", "sum"])
    membership_bits = int(rng.integers(2, 13))

    def criterion():
        return {
            "window": int(rng.choice([1, 3, 3, 5, 7])),
            "dx": int(rng.integers(-3, 4)),
            "label_bits": int(rng.integers(max(4, membership_bits), 15)),
        }

    criteria = [criterion() for _ in range(3 if cost == "fuzzy" else 1)]
    if all(c["window"] == 1 for c in criteria):  # which the configuration refuses
        criteria[0]["window"] = 3
    disparities = int(rng.integers(2, 9))
    compensation = {}
    if cost == "fuzzy" and rng.random() < 0.6:
        looked_at = int(rng.integers(4))
        if looked_at == 0:
            criteria[rng.integers(3)].update(window=3, dx=0)
        compensation = {
            "criterion": looked_at,
            "reading": str(rng.choice(["top", "literal"])),
            "threshold": int(rng.integers(0, 3000)),
            "from_disparity": int(rng.integers(0, disparities)),
        }
    return Config.from_dict(
        {
            "disparities": disparities,
            "lanes": 1,
            "cost": str(cost),
            "operator": str(rng.choice(OPERATORS)),
            "softness": float(rng.choice([0.05, rng.random()])),
            "sharpness": float(rng.choice([-100, 100, rng.uniform(-500, 500)])),
            "max_multipliers": 1000,
            "rules": str(rng.choice(["printed", "corrected"])),
            "reference": str(rng.choice(["left", "right"])),
            "membership_bits": membership_bits,
            "criteria": criteria,
            "compensation": compensation,
            "max_width": 64,
            "firing": str(rng.choice(["all", "cell"])),
        }
    )


def random_pair(rng, config):
    """Noise of random depth, a little smaller or larger than the support: two levels make ties."""
    height = max(1, config.min_height + rng.integers(-1, 9))
    width = max(1, config.min_width + rng.integers(-1, 24))
    levels = int(rng.choice([2, 4, 256]))
    contrast = int(rng.integers(1, 255 // (levels - 1) + 1))
    return (rng.integers(0, levels, (2, height, width, 3)) * contrast).astype(np.uint8)


def as_pairs(result):
    return [
        list(zip(*rows, strict=True))
        for rows in zip(result.disparity.tolist(), result.code.tolist(), strict=True)
    ]


@pytest.mark.parametrize("seed", range(160))
def test_random_configurations_match_the_loops(seed):
    rng = np.random.default_rng(seed)
    config = random_config(rng)
    left, right = random_pair(rng, config)
    got = as_pairs(fixed_model.disparity(left, right, config))
    assert got == loop_model(left, right, config), config.to_toml()


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize(("label_bits", "membership_bits"), [(4, 2), (4, 4), (12, 12), (20, 12), (20, 2)])
@pytest.mark.parametrize("reading", ["off", "top", "literal"])
@pytest.mark.parametrize("firing", ["all", "cell"])
def test_extreme_widths_match_the_loops(operator, label_bits, membership_bits, reading, firing):
    criteria = [{"window": w, "label_bits": label_bits} for w in (3, 13, 15)]
    config = Config.from_dict(
        {
            "disparities": 4,
            "lanes": 1,
            "operator": operator,
            "firing": firing,
            "max_multipliers": 1000,
            "membership_bits": membership_bits,
            "criteria": criteria,
            "compensation": {"reading": reading, "from_disparity": 2},
        }
    )
    rng = np.random.default_rng(label_bits)
    left = rng.integers(0, 2, (15, 19, 3), dtype=np.uint8) * np.uint8(255)
    right = left.copy()
    right[:, 8:] = 255 - left[:, 8:]  # sums from 0 up to all that a window can hold
    got = as_pairs(fixed_model.disparity(left, right, config))
    assert got == loop_model(left, right, config)


def test_random_configurations_reach_every_branch():
    drawn = [random_config(np.random.default_rng(seed)) for seed in range(160)]
    assert {c.compensation.reading for c in drawn} == {"off", "top", "literal"}
    assert {(c.operator, c.rules, c.reference) for c in drawn if c.cost == "fuzzy"} == {
        (operator, rules, view)
        for operator in OPERATORS
        for rules in ("printed", "corrected")
        for view in ("left", "right")
    }
    assert {(c.operator, c.rules, c.firing) for c in drawn if c.cost == "fuzzy"} == {
        (operator, rules, firing)
        for operator in OPERATORS
        for rules in ("printed", "corrected")
        for firing in ("all", "cell")
    }
    assert {c.membership_bits for c in drawn} == set(range(2, 13))
    assert any(c.cost == "sum" for c in drawn)
    assert {c.compensation.criterion for c in drawn} == set(range(4))
    soft = [c for c in drawn if c.cost == "fuzzy" and c.operator == "soft_min_2"]
    assert {c.sharpness > 0 for c in soft} == {False, True}


def test_table_1_and_the_loops_use_each_rule_once():
    for table in (TABLE_1, CORRECTED):
        rules = [rule for row in table.values() for rule in row]
        assert sorted(rules) == sorted(
            f"{a}1 {b}2 {c}3" for a in (1, 2, 3) for b in (1, 2, 3) for c in (1, 2, 3)
        )
