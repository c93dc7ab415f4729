"""How large the numbers of a configuration's costs get, and what multiplies them."""

from typing import TYPE_CHECKING

from softdepth.spec.operators import REGISTRY, Range
from softdepth.spec.rules import weight

if TYPE_CHECKING:
    from softdepth.spec.config import Config

MULTIPLIER_BITS = 18
COMPARISON_STEPS = 4
"""Steps from one comparison of fractions to the next that takes its result."""
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


def right_parts(lanes: int, steps: int) -> int:
    """Parts of a right pixel's candidates, costs being fractions, of which each has a best of its own first.

    Its candidates in a lane are ``steps - 1`` steps apart, those of two lanes with the same step
    ``steps**2``. Where the former is too little, each step is a part, and where the latter is, each step in
    every few lanes.
    """
    if steps > COMPARISON_STEPS:
        return 1
    return steps * min(lanes, -(-COMPARISON_STEPS // steps**2))


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
    if config.post.check:
        comparisons += config.lanes + right_parts(config.lanes, config.steps) - 1
    (num_low, num_high), (_, den_high) = costs(config)
    sign = num_low < 0
    num = max(num_high.bit_length(), (~num_low).bit_length()) + sign
    den = den_high.bit_length() + sign
    products = supports + REGISTRY[config.operator].products
    return 2 * comparisons * tiles(num) * tiles(den) + products * config.lanes
