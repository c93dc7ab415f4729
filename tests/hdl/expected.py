"""The method in plain Python, one candidate at a time: what the blocks' tests compare with."""

from collections.abc import Sequence

from softdepth.config import Config
from softdepth.rules import rule_base, weight
from softdepth.validity import Validity

Pixel = Sequence[int]
Column = Sequence[Pixel]
Triple = tuple[int, int, int]


def memberships(value: int, label_bits: int, config: Config) -> Triple:
    """Low, middle and high degree (eq. 9), with labels at 0, T and 2T."""
    one = 2**config.membership_bits
    u = min(value, 2 * 2**label_bits) // 2 ** (label_bits - config.membership_bits)
    return max(one - u, 0), one - abs(u - one), max(u - one, 0)


def theta(operator: str, a: int, b: int, c: int) -> int:
    """The fuzzy AND (eq. 2 and 4); the mean without its third."""
    return {"min": min(a, b, c), "mean": a + b + c}[operator]


def conclusions(degrees: Sequence[Triple], config: Config) -> dict[int, int]:
    """``Y_k``: the maximum over all rules of conclusion k, each evaluated by itself."""
    first, second, third = degrees
    return {
        k: max(theta(config.operator, first[a - 1], second[b - 1], third[c - 1]) for a, b, c in rules)
        for k, rules in rule_base(config.rules).items()
    }


def compensated(values: Sequence[int], near: bool, config: Config) -> list[int]:
    """The criteria after the compensating rule."""
    rule = config.compensation
    if rule.reading == "off" or not near:
        return list(values)
    centred = next(i for i, c in enumerate(config.criteria) if (c.window, c.dx) == (3, 0))
    if values[centred] <= rule.threshold:
        return list(values)
    return [2 * 2**c.label_bits if rule.reading == "top" else 1000 for c in config.criteria]


def fraction(values: Sequence[int], near: bool, config: Config) -> tuple[int, int]:
    """The cost ``N / S`` (eq. 10) of a candidate with these criteria; its denominator is 1 for plain SAD."""
    if config.cost == "sad":
        return values[0], 1
    inputs = compensated(values, near, config)
    degrees = [memberships(v, c.label_bits, config) for v, c in zip(inputs, config.criteria, strict=True)]
    y = conclusions(degrees, config)
    return sum(y[k] * weight(k) for k in y), sum(y.values())


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
