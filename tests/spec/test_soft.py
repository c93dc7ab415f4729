"""The soft operators' tables against equations 5 and 6, evaluated to forty digits."""

import math
from decimal import Decimal, localcontext
from itertools import pairwise

import pytest

from softdepth.spec.soft import soft_min_1_table, soft_min_2_table

HALF = Decimal("0.5")
BITS = (2, 3, 4, 8, 12)
SOFTNESSES = (0.0, 0.003, 0.05, 0.3, 0.4, 0.75, 1.0)
SHARPNESSES = (-500.0, -100.0, -30.0, -1.0, -0.2, 0.0, 0.2, 1.0, 30.0, 100.0, 500.0)


def eq_5(a, b, delta):
    with localcontext(prec=40):
        d = Decimal(delta)
        return (a + b + d**2 - ((a - b) ** 2 + d**2).sqrt()) / 2


def eq_6(a, b, k):
    with localcontext(prec=40):
        p, q = ((-Decimal(k) * x).exp() for x in (a, b))
        return (a * p + b * q) / (p + q)


def entry(table, index):
    return table[min(index, len(table) - 1)]


def soft_1(a, b, one, softness):
    """Soft-min I as both models have it: the minimum plus the table's entry."""
    return min(a, b) + entry(soft_min_1_table(one, softness), abs(a - b))


def soft_2(a, b, one, sharpness):
    correction = entry(soft_min_2_table(one, sharpness), abs(a - b))
    return max(a, b) - correction if sharpness < 0 else min(a, b) + correction


@pytest.mark.parametrize("softness", SOFTNESSES)
@pytest.mark.parametrize("bits", BITS)
def test_soft_min_1_is_equation_5_rounded(bits, softness):
    """Of a full operand and any other; below zero too, where nested operands go."""
    one = 1 << bits
    lowest = soft_1(0, 0, one, softness)
    assert lowest == math.floor(eq_5(Decimal(0), Decimal(0), softness) * one + HALF)
    for low in range(lowest, one + 1, max(1, one // 512)):
        exact = eq_5(Decimal(low) / one, Decimal(1), softness) * one
        assert soft_1(low, one, one, softness) == math.floor(exact + HALF)


@pytest.mark.parametrize("sharpness", SHARPNESSES)
@pytest.mark.parametrize("bits", BITS)
def test_soft_min_2_is_equation_6_rounded(bits, sharpness):
    one = 1 << bits
    for low in range(0, one + 1, max(1, one // 512)):
        exact = eq_6(Decimal(low) / one, Decimal(1), sharpness) * one
        # The correction is rounded half up; it is what k < 0 subtracts.
        expected = math.floor(exact + HALF) if sharpness >= 0 else math.ceil(exact - HALF)
        assert soft_2(low, one, one, sharpness) == soft_2(one, low, one, sharpness) == expected


@pytest.mark.parametrize("softness", SOFTNESSES)
@pytest.mark.parametrize("bits", BITS)
def test_soft_min_1_grows_by_at_most_one(bits, softness):
    """So that the minimum, which it is added to, makes good what it loses."""
    table = soft_min_1_table(1 << bits, softness)
    assert {after - before for before, after in pairwise(table)} <= {0, 1}


@pytest.mark.parametrize("softness", SOFTNESSES)
def test_soft_min_1_is_monotone_on_its_whole_range(softness):
    one = 32
    lowest = soft_1(0, 0, one, softness)
    for a in range(lowest, one):
        for b in range(lowest, one + 1):
            assert soft_1(a, b, one, softness) <= soft_1(a + 1, b, one, softness)
            assert soft_1(a, b, one, softness) == soft_1(b, a, one, softness)


@pytest.mark.parametrize("sharpness", SHARPNESSES)
def test_soft_min_2_lies_between_its_operands(sharpness):
    one = 64
    for a in range(one + 1):
        for b in range(a, one + 1):
            found = soft_2(a, b, one, sharpness)
            assert a <= found <= b
            # On the side of k: never beyond the middle by more than the rounding.
            assert 2 * found <= a + b + 1 if sharpness >= 0 else 2 * found >= a + b - 1


@pytest.mark.parametrize(
    ("bits", "sharpness"), [(8, 30.0), (8, 100.0), (8, -100.0), (12, 500.0), (12, -500.0)]
)
def test_soft_min_2_is_not_monotone(bits, sharpness):
    """Nor is equation 6: its weighted mean falls where an operand recedes from the one that rules."""
    one = 1 << bits
    found = [soft_2(a, one // 2, one, sharpness) for a in range(one + 1)]
    falls = [a for a in range(one) if found[a + 1] < found[a]]
    assert falls
    assert {found[a] - found[a + 1] for a in falls} == {1}
    third = Decimal(1) / 3
    exact = [
        eq_6(third, third + d / Decimal(abs(sharpness)) * (-1 if sharpness < 0 else 1), sharpness)
        for d in (1, 3)
    ]
    assert exact[1] < exact[0] if sharpness > 0 else exact[1] > exact[0]


def test_hard_ends_of_softness_and_sharpness():
    assert soft_min_1_table(256, 0.0) == (0,)
    assert [soft_2(0, d, 256, 0.0) for d in range(257)] == [(d + 1) // 2 for d in range(257)]  # the mean
    assert soft_min_2_table(4, 500.0) == soft_min_2_table(4, -500.0) == (0,)


@pytest.mark.parametrize("table", [soft_min_1_table(256, 0.05), soft_min_2_table(256, -100.0)])
def test_tables_of_the_paper_are_small(table):
    """Some constants in place of roots and exponentials, and none repeated at the end."""
    assert len(table) < 64
    assert max(abs(value) for value in table) <= 6
    assert table[-1] != table[-2]


def test_tables_of_the_paper_by_value():
    assert (soft_min_1_table(256, 0.05)[0], soft_min_1_table(256, 0.05)[-1]) == (-6, 0)
    assert max(soft_min_2_table(256, 100.0)) == 1  # 0.2785 / |k| at most, in units of 1/256
