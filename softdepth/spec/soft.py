"""The soft operators in integers (Bobyr et al. 2021, eqs. 5 and 6): tables derived from the formulas.

Both are a hard minimum or maximum plus a small correction that depends only on ``|a - b|``:

- soft-min I: ``(a + b + D**2 - sqrt((a-b)**2 + D**2)) / 2 = min(a, b) + g(|a-b|)`` with
  ``g(d) = (d + D**2 - sqrt(d**2 + D**2)) / 2``; D is `Config.softness`.
- soft-min II of two operands: ``min(a, b) + h(|a-b|)`` for k > 0 and ``max(a, b) - h(|a-b|)`` for
  k < 0, with ``h(d) = d / (1 + exp(|k| * d))``; k is `Config.sharpness`.

A table holds the correction in units of ``1 / one``, rounded half up, for ``d = 0, 1, ...``; its last
entry holds for every larger d.
"""

import math
from functools import cache

Table = tuple[int, ...]


@cache
def soft_min_1_table(one: int, softness: float) -> Table:
    """``g`` for all differences of strengths in units of ``1 / one``."""

    def g(d: float) -> float:
        return (d + softness**2 - math.hypot(d, softness)) / 2

    # A pair is as low as g(0) below zero, so that differences exceed one by as much.
    reach = one - _rounded(one * g(0))
    return _trimmed([_rounded(one * g(d / one)) for d in range(reach + 1)])


@cache
def soft_min_2_table(one: int, sharpness: float) -> Table:
    """``h`` for all differences of strengths in units of ``1 / one``."""
    k = abs(sharpness)
    # exp overflows where h is practically 0 already.
    return _trimmed([_rounded(d / (1 + math.exp(min(k * d / one, 700.0)))) for d in range(one + 1)])


def _rounded(value: float) -> int:
    return math.floor(value + 0.5)


def _trimmed(values: list[int]) -> Table:
    """Without the repetitions of the last value at the end."""
    while len(values) > 1 and values[-2] == values[-1]:
        values.pop()
    return tuple(values)
