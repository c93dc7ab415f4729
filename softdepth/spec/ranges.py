"""How large the numbers of a configuration's costs get, and what multiplies them."""

from typing import TYPE_CHECKING

from softdepth.spec.criteria import Census
from softdepth.spec.rules import CONCLUSIONS, weight
from softdepth.spec.soft import soft_min_1_table

if TYPE_CHECKING:
    from softdepth.spec.config import Config

MULTIPLIER_BITS = 18
CELL_PRODUCTS = 4
"""Products that PROD takes in a lane: the others follow from these, as a criterion's memberships sum to 1."""
QUOTIENT_BITS = 6
"""Fraction bits of a fuzzy cost where it is wanted as a number: between candidates, and as a margin."""

Range = tuple[int, int]


def strengths(config: "Config") -> Range:
    """See `Config.strength_range`."""
    match config.operator:
        case "mean":
            return 0, 3 * config.one
        case "soft_min_1":
            # Twice Theta of equal operands at both ends of the range: it is monotone.
            table = soft_min_1_table(config.one, config.softness)
            nested = table[0] + table[min(-table[0], len(table) - 1)]
            return nested, config.one + nested
        case _:
            return 0, config.one


def costs(config: "Config") -> tuple[Range, Range]:
    """See `Config.cost_range`."""
    if config.cost == "sum":
        return (0, sum(c.maximum for c in config.criteria)), (1, 1)
    one = config.one
    low, high = strengths(config)
    match config.operator, config.rules, config.by_cell:
        # Extremes of what is piecewise linear in the criteria: at corners and centres of cells.
        case "mean", "printed", False:
            return (-27 * one, 26 * one), (0, 19 * one)
        case "mean", "printed", True:
            return (-32 * one, 30 * one), (7 * one, 11 * one)
        case "mean", "corrected", True:
            return (-32 * one, 32 * one), (9 * one, 11 * one)
        case "min", _, _:
            return (-15 * one // 2, 15 * one // 2), (one // 2, 3 * one)
        case "prod", _, _:
            # A cell's strengths sum to `one` but for what rounding adds.
            return (-5 * (one + 3), 5 * (one + 3)), (1, one + 3)
        case _, _, True:
            # Six conclusions of successive weights, 0 .. 5 and 0 .. -5 the worst. Soft-min I is
            # concave, so that its least sum is near a corner of the cell: above a third of `one`.
            return (-15 * high, 15 * high), (one // 4, 6 * high)
    positive = sum(weight(k) for k in range(1, CONCLUSIONS + 1) if weight(k) > 0)
    reach = positive * (high - low)
    return (-reach, reach), (CONCLUSIONS * low, CONCLUSIONS * high)


def numbers(config: "Config") -> Range:
    """See `Config.number_range`."""
    if config.cost == "sum":
        return costs(config)[0]
    reach = 1 << (weight(1) - 1).bit_length() << QUOTIENT_BITS
    return -reach, reach - 1


def multipliers(config: "Config") -> int:
    """See `Config.multipliers`. A comparison of fractions takes two products; those wider than a
    multiplier take several."""
    supports = sum(isinstance(c, Census) and c.taps > 1 for c in config.criteria)
    if config.cost == "sum":
        return config.lanes * supports

    def tiles(bits: int) -> int:
        return -(-bits // MULTIPLIER_BITS)

    comparisons = config.lanes - 1 + (config.steps - 1).bit_length()
    (num_low, num_high), (_, den_high) = costs(config)
    sign = num_low < 0
    num = max(num_high.bit_length(), (~num_low).bit_length()) + sign
    den = den_high.bit_length() + sign
    products = supports + (CELL_PRODUCTS if config.operator == "prod" else 0)
    return 2 * comparisons * tiles(num) * tiles(den) + products * config.lanes
