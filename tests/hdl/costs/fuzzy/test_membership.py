"""Membership: every input of several widths."""

import pytest

from softdepth.hdl.costs.fuzzy.membership import Membership
from tests.support.expected import memberships
from tests.support.simulation import config, piped, sad


@pytest.mark.parametrize(
    ("label_bits", "membership_bits", "maximum"),
    [
        (4, 2, 40),  # saturates
        (4, 4, 100),  # no shift
        (6, 3, 127),  # ends right below 2T
        (6, 5, 128),  # ends at 2T
        (6, 5, 129),
        (8, 8, 765),
        (9, 2, 765),  # never reaches 2T
        (10, 8, 765),  # never reaches T
    ],
)
def test_all_inputs(label_bits: int, membership_bits: int, maximum: int) -> None:
    c = config(criteria=[sad(3, label_bits=label_bits)] * 3, membership_bits=membership_bits)
    inputs = range(maximum + 1)
    got = piped(Membership(c, label_bits, maximum), [{"i": value} for value in inputs])
    for value, o in zip(inputs, got, strict=True):
        assert (o.low, o.middle, o.high) == memberships(value, label_bits, c), value
        assert o.low + o.middle + o.high == 2**membership_bits
