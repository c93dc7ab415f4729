"""The method in plain Python, one candidate at a time: what the blocks' tests compare with."""

import math
from collections.abc import Sequence
from decimal import Decimal, localcontext
from fractions import Fraction
from functools import cache

from softdepth.spec.config import Config, Operator
from softdepth.spec.rules import rule_base, weight
from softdepth.spec.validity import Validity

Pixel = Sequence[int]
Column = Sequence[Pixel]
Triple = tuple[int, int, int]


def memberships(value: int, label_bits: int, config: Config) -> Triple:
    """Low, middle and high degree (eq. 9), with labels at 0, T and 2T."""
    one = 2**config.membership_bits
    u = min(value, 2 * 2**label_bits) // 2 ** (label_bits - config.membership_bits)
    return max(one - u, 0), one - abs(u - one), max(u - one, 0)


def eq_5(a: Fraction, b: Fraction, delta: float) -> Decimal:
    """Soft-min I as printed, to forty digits."""
    with localcontext(prec=40):
        x, y, d = _decimal(a), _decimal(b), Decimal(delta)
        return (x + y + d**2 - ((x - y) ** 2 + d**2).sqrt()) / 2


def eq_6(a: Fraction, b: Fraction, k: float) -> Decimal:
    """Soft-min II as printed, of two operands, to forty digits."""
    with localcontext(prec=40):
        x, y, steepness = _decimal(a), _decimal(b), Decimal(k)
        p, q = (-steepness * x).exp(), (-steepness * y).exp()
        return (x * p + y * q) / (p + q)


def theta_2(a: int, b: int, config: Config) -> int:
    """The fuzzy AND (eqs. 2 to 6) of two operands in units of ``1 / one``; the mean without its divisor.

    What is not whole is rounded to the nearest, halves up; below a soft maximum, down.
    """
    return _theta_2(config.operator, a, b, 2**config.membership_bits, config.softness, config.sharpness)


@cache
def _theta_2(operator: Operator, a: int, b: int, one: int, softness: float, sharpness: float) -> int:
    x, y = Fraction(a, one), Fraction(b, one)
    match operator:
        case "min":
            return min(a, b)
        case "mean":
            return a + b
        case "prod":
            return math.floor(x * y * one + Fraction(1, 2))
        case "soft_min_1":
            return math.floor(eq_5(x, y, softness) * one + Decimal("0.5"))
        case "soft_min_2":
            exact = eq_6(x, y, sharpness) * one
            if sharpness < 0:
                return math.ceil(exact - Decimal("0.5"))
            return math.floor(exact + Decimal("0.5"))


def theta(a: int, b: int, c: int, config: Config) -> int:
    """A rule's firing strength."""
    return theta_2(a, theta_2(b, c, config), config)


def conclusions(degrees: Sequence[Triple], config: Config) -> dict[int, int]:
    """``Y_k``: the maximum over conclusion k's rules that fire, each evaluated by itself; 0 without any.

    For soft-min II, which is not monotone, rules that agree in criterion 1 are joined first.
    """
    first, second, third = degrees
    found = {}
    for k, rules in rule_base(config.rules).items():
        fired = [rule for rule in rules if config.firing == "all" or in_cell(rule, degrees)]
        if config.operator == "soft_min_2":
            pairs: dict[int, int] = {}
            for a, b, c in fired:
                pairs[a] = max(pairs.get(a, -1), theta_2(second[b - 1], third[c - 1], config))
            strengths = [theta_2(first[a - 1], pair, config) for a, pair in pairs.items()]
        else:
            strengths = [theta(first[a - 1], second[b - 1], third[c - 1], config) for a, b, c in fired]
        found[k] = max(strengths, default=0)
    return found


def in_cell(rule: Triple, degrees: Sequence[Triple]) -> bool:
    """Whether the rule has no label on the far side of T, for any criterion."""
    return all(label != (3 if low > 0 else 1) for label, (low, _, _) in zip(rule, degrees, strict=True))


def compensated(values: Sequence[int], near: bool, config: Config) -> list[int]:
    """The criteria after the compensating rule."""
    rule = config.compensation
    if rule.reading == "off" or not near:
        return list(values)
    centred = (i for i, c in enumerate(config.criteria) if (c.window, c.dx) == (3, 0))
    looked_at = rule.criterion - 1 if rule.criterion else next(centred)
    if values[looked_at] <= rule.threshold:
        return list(values)
    return [2 * 2**c.label_bits if rule.reading == "top" else 1000 for c in config.criteria]


def fraction(values: Sequence[int], near: bool, config: Config) -> tuple[int, int]:
    """The cost ``N / S`` (eq. 10) of a candidate with these criteria; its denominator is 1 for plain SAD.

    A sum S that is not above zero judges nothing: the cost is infinite, 1 / 0.
    """
    if config.cost == "sum":
        return values[0], 1
    inputs = compensated(values, near, config)
    degrees = [memberships(v, c.label_bits, config) for v, c in zip(inputs, config.criteria, strict=True)]
    y = conclusions(degrees, config)
    total = sum(y.values())
    return (sum(y[k] * weight(k) for k in y), total) if total > 0 else (1, 0)


def window_sums(left: Sequence[Column], right: Sequence[Column], config: Config) -> list[list[int]]:
    """For each column that entered, every criterion at the pixel `reach_right` columns before it.

    ``left`` and ``right`` are the columns a candidate compares, as high as the support. A sum whose
    window is not there yet is -1.
    """
    sums = []
    for entered in range(len(left)):
        values = []
        for criterion in config.criteria:
            centre = entered - config.reach_right + criterion.dx
            columns = range(centre - criterion.radius, centre + criterion.radius + 1)
            rows = range(config.reach_rows - criterion.radius, config.reach_rows + criterion.radius + 1)
            if columns[0] < 0:
                values.append(-1)
                continue
            pairs = [(left[x][y], right[x][y]) for x in columns for y in rows]
            values.append(sum(abs(p - q) for a, b in pairs for p, q in zip(a, b, strict=True)))
        sums.append(values)
    return sums


def code(x: int, y: int, width: int, height: int, config: Config) -> Validity:
    """Why the pixel (x, y) has, or has no, result."""
    if not config.reach_left <= x < width - config.reach_right:
        return Validity.BORDER
    if not config.reach_rows <= y < height - config.reach_rows:
        return Validity.BORDER
    return Validity.FULL if x - config.reach_left >= config.disparities - 1 else Validity.PARTIAL


def _decimal(value: Fraction) -> Decimal:
    """A dyadic fraction, exactly."""
    return Decimal(value.numerator) / value.denominator
