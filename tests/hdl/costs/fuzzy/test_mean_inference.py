"""MeanInference: the closed form equals the fixed model's rules, for every position of the criteria."""

from itertools import product
from random import Random

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.hdl.costs.fuzzy.inference import RuleInference
from softdepth.hdl.costs.fuzzy.mean_inference import MeanInference
from tests.support.inferences import around_the_labels, gateware, model, positions, settings, small

SMALL = small(settings)


@pytest.mark.parametrize("name", SMALL)
def test_equals_the_fixed_model_at_every_position(name: str) -> None:
    c = SMALL[name]
    sets = list(product(*(positions(c, i) for i in range(3))))
    assert gateware(MeanInference, c, sets) == model(c, sets)


@pytest.mark.parametrize(
    ("bits", "labels"), [(8, (12, 12, 12)), (8, (8, 10, 13)), (5, (9, 9, 9)), (12, (12,) * 3)]
)
def test_equals_the_fixed_model_at_many_bits(bits: int, labels: tuple[int, ...]) -> None:
    c = settings(bits, *labels, windows=(9, 9, 9))
    random = Random(bits)
    sets = [tuple(around_the_labels(c, i, random) for i in range(3)) for _ in range(3000)]
    for pair in ((0, 1), (1, 2), (0, 2)):  # equal ones, in which s and d change their sign
        for _ in range(300):
            values = [around_the_labels(c, i, random) for i in range(3)]
            a, b = pair
            shift = c.criteria[a].label_bits - c.criteria[b].label_bits
            values[b] = min(values[a] >> max(shift, 0) << max(-shift, 0), c.maxima[b])
            sets.append(tuple(values))
    assert gateware(MeanInference, c, sets) == model(c, sets)


def test_equals_the_inference_over_all_rules() -> None:
    """The other component for the same configuration."""
    c = settings(4, 6, 6, 6)
    random = Random(7)
    sets = [tuple(around_the_labels(c, i, random) for i in range(3)) for _ in range(800)]
    assert gateware(MeanInference, c, sets) == gateware(RuleInference, c, sets)


@pytest.mark.parametrize("bits", [2, 3, 4])
def test_the_stated_range_is_reached_and_never_left(bits: int) -> None:
    """By the model, over all positions: so no bit of the numerator is missing, and none is idle."""
    c = settings(bits, *[max(bits, 4)] * 3)
    (num_low, num_high), (den_low, den_high) = c.cost_range
    unit = 1 << (c.criteria[0].label_bits - bits)
    values = [u * unit for u in range(2 * c.one + 1)]
    num, den = zip(*model(c, list(product(values, repeat=3))), strict=True)
    assert (min(num), max(num)) == (num_low, num_high)
    assert max(den) == den_high
    assert min(den) >= den_low > 0


def test_the_range_holds_at_eight_bits() -> None:
    c = settings(8, 8, 8, 8)
    (num_low, num_high), (_, den_high) = c.cost_range
    rng = np.random.default_rng(3)
    columns = list(rng.integers(0, 2 * c.one + 1, (3, 400_000), dtype=np.int32))
    num, den = fixed_model.fraction(c, 0, columns)
    assert num_low <= num.min() <= num.max() <= num_high
    assert 0 < den.min() <= den.max() <= den_high
