"""How large the numbers of a configuration's costs get, and what multiplies them."""

from typing import TYPE_CHECKING

from softdepth.spec.operators import REGISTRY, Range
from softdepth.spec.rules import weight

if TYPE_CHECKING:
    from softdepth.spec.config import Config

MULTIPLIER_BITS = 18
QUOTIENT_BITS = 6
"""Fraction bits of a fuzzy cost where it is wanted as a number: between candidates, and as a margin."""


def costs(config: "Config") -> tuple[Range, Range]:
    """See `Config.cost_range`."""
    if config.cost == "sum":
        return (0, sum(config.maxima)), (1, 1)
    return REGISTRY[config.operator].cost_range(config)


def numbers(config: "Config") -> Range:
    """See `Config.number_range`."""
    if config.cost == "sum":
        return costs(config)[0]
    reach = 1 << (weight(1) - 1).bit_length() << QUOTIENT_BITS
    return -reach, reach - 1


def multipliers(config: "Config") -> int:
    """See `Config.multipliers`. A comparison of fractions takes two products; those wider than a
    multiplier take several."""
    supports = sum(c.products for c in config.criteria)
    if config.cost == "sum":
        return config.lanes * supports

    def tiles(bits: int) -> int:
        return -(-bits // MULTIPLIER_BITS)

    comparisons = config.lanes - 1 + (config.steps - 1).bit_length()
    comparisons *= 1 + config.post.confidence  # the runner-up's are as many
    comparisons += config.lanes * config.post.check
    (num_low, num_high), (_, den_high) = costs(config)
    sign = num_low < 0
    num = max(num_high.bit_length(), (~num_low).bit_length()) + sign
    den = den_high.bit_length() + sign
    products = supports + REGISTRY[config.operator].products
    return 2 * comparisons * tiles(num) * tiles(den) + products * config.lanes
