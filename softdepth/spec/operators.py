"""The fuzzy AND of a rule, Theta (Bobyr et al. 2021, eqs. 2 to 6): what each operator says about itself.

The ranges of strengths and costs, and so every width behind them, follow from this: for linear operators
from a walk over the cells, for others from what Theta gives at its ends, unless the operator states
narrower ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

from softdepth.spec.registry import Registry
from softdepth.spec.rules import CONCLUSIONS, Firing, RuleBaseName, rule_base, weight
from softdepth.spec.soft import soft_min_1_table, soft_min_2_table

if TYPE_CHECKING:
    from softdepth.spec.config import Config

Range = tuple[int, int]
Theta = Callable[[int, int], int]
"""Theta of two operands in units of ``1 / one``; of three by nesting, ``Theta(a, Theta(b, c))``."""


GRID = 6
"""Steps of a membership in the walk over the cells."""


@dataclass(frozen=True)
class Operator:
    """What the configuration, and all that is derived from it, needs to know about an operator.

    Members
    -------
    title : for tables.
    theta : the integer Theta for a configuration; monotone in both operands, or nearly.
    linear : it is made of sums, minima and maxima, so that its extremes are where these meet.
    zeroing : a membership of 0 gives a strength of 0, so only the rules of a cell count.
    products : multipliers that it takes in a lane.
    scale : what a strength of 1.0 is in units of `Config.one`.
    costs : ranges of numerator and denominator where narrower ones than the derived are known, or None.
    """

    title: str
    theta: Callable[[Config], Theta]
    linear: bool = False
    zeroing: bool = False
    products: int = 0
    scale: int = 1
    costs: Callable[[Config], tuple[Range, Range] | None] = lambda _: None

    def strength_range(self, config: Config) -> Range:
        """Smallest and largest firing strength: those of equal operands at both ends."""
        theta, one = self.theta(config), config.one
        return theta(0, theta(0, 0)), theta(one, theta(one, one))

    def cost_range(self, config: Config) -> tuple[Range, Range]:
        """Smallest and largest numerator, and the same of the denominator."""
        stated = self.costs(config)
        if stated:
            return stated
        if self.linear:
            firing: Firing = "cell" if config.by_cell else "all"
            (n_low, n_high), (s_low, s_high) = _walk(self.theta(config), config.rules, firing)

            def up(value: int) -> int:
                return -(-value * config.one // GRID)

            return (-up(-n_low), up(n_high)), (-up(-s_low), up(s_high))
        return _of_strengths(self.strength_range(config))


def _of_strengths(strengths: Range) -> tuple[Range, Range]:
    """The range if conclusions could have any strengths, whether or not these occur together."""
    low, high = strengths
    positive = sum(weight(k) for k in range(1, CONCLUSIONS + 1) if weight(k) > 0)
    reach = positive * (high - low)
    return (-reach, reach), (CONCLUSIONS * low, CONCLUSIONS * high)


@lru_cache
def _walk(theta: Theta, rules: RuleBaseName, firing: Firing) -> tuple[Range, Range]:
    """The extremes of numerator and denominator over all cells, in units of ``1 / GRID``.

    What is linear between the cells' corners, centres and the planes where two rules are equally strong has
    its extremes where these meet: at halves and thirds of a cell.
    """
    numerators, denominators = zip(*_costs(theta, GRID, rules, firing), strict=True)
    return (min(numerators), max(numerators)), (min(denominators), max(denominators))


def _costs(theta: Theta, one: int, rules: RuleBaseName, firing: Firing) -> Iterator[Range]:
    """Numerator and denominator for all inputs; with the rules of a cell, from both sides of T."""
    if firing == "all":
        places = [(u, (1, 2, 3)) for u in range(2 * one + 1)]
    else:
        places = [(u, (1, 2)) for u in range(one + 1)] + [(u, (2, 3)) for u in range(one, 2 * one + 1)]
    for inputs in product(places, repeat=3):
        degrees = [(max(one - u, 0), one - abs(u - one), max(u - one, 0)) for u, _ in inputs]
        live = [labels for _, labels in inputs]
        n = s = 0
        for k, members in rule_base(rules).items():
            strengths = [
                theta(degrees[0][a - 1], theta(degrees[1][b - 1], degrees[2][c - 1]))
                for a, b, c in members
                if a in live[0] and b in live[1] and c in live[2]
            ]
            strength = max(strengths, default=0)
            n += weight(k) * strength
            s += strength
        yield n, s


REGISTRY: Registry[Operator] = Registry("operator")
"""The operators by the values of `Config.operator`."""


def _minimum(a: int, b: int) -> int:
    return min(a, b)


def _total(a: int, b: int) -> int:
    return a + b


def _product(config: Config) -> Theta:
    bits = config.membership_bits
    return lambda a, b: (a * b + (1 << bits >> 1)) >> bits


def _soft_min_1(config: Config) -> Theta:
    table = soft_min_1_table(config.one, config.softness)
    return lambda a, b: min(a, b) + table[min(abs(a - b), len(table) - 1)]


def _soft_min_2(config: Config) -> Theta:
    table = soft_min_2_table(config.one, config.sharpness)

    def theta(a: int, b: int) -> int:
        correction = table[min(abs(a - b), len(table) - 1)]
        return max(a, b) - correction if config.sharpness < 0 else min(a, b) + correction

    return theta


def _costs_of_product(config: Config) -> tuple[Range, Range]:
    """A cell's strengths sum to `one`, except for what rounding adds."""
    most = config.one + 3
    return (-5 * most, 5 * most), (1, most)


def _costs_of_mean(config: Config) -> tuple[Range, Range] | None:
    """All rules of the corrected table pass through sums whose words follow from the strengths alone."""
    return (
        _of_strengths(config.strength_range) if config.rules == "corrected" and not config.by_cell else None
    )


def _costs_of_soft(config: Config) -> tuple[Range, Range] | None:
    """Six conclusions of successive weights, 0 .. 5 and 0 .. -5 the worst.

    Soft-min I is concave, so its smallest sum is near a corner of the cell: above a third of `one`.
    """
    _, high = config.strength_range
    return ((-15 * high, 15 * high), (config.one // 4, 6 * high)) if config.by_cell else None


REGISTRY.register("min", Operator("MIN", lambda _: _minimum, linear=True, zeroing=True))
REGISTRY.register("prod", Operator("PROD", _product, zeroing=True, products=4, costs=_costs_of_product))
REGISTRY.register("mean", Operator("MEAN", lambda _: _total, linear=True, scale=3, costs=_costs_of_mean))
REGISTRY.register("soft_min_1", Operator("Soft-min I", _soft_min_1, costs=_costs_of_soft))
REGISTRY.register("soft_min_2", Operator("Soft-min II", _soft_min_2, costs=_costs_of_soft))
# PROD takes four products in a lane: the others follow from these, as a criterion's memberships sum to 1.
