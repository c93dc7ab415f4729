"""The five operators in integers, as the gateware computes them. ``one`` stands for 1.0."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.fuzzy.inference import Memberships, PairTheta, conclusions, joined_conclusions
from softdepth.spec.config import Config
from softdepth.spec.registry import Registry
from softdepth.spec.soft import Table, soft_min_1_table, soft_min_2_table

Integers = NDArray[np.signedinteger[Any]]


def minimum(a: Integers, b: Integers) -> Integers:
    """MIN (eq. 2)."""
    return np.minimum(a, b)


def product(a: Integers, b: Integers, *, bits: int) -> Integers:
    """PROD (eq. 3): the exact product in units of ``1 / one = 2**-bits``, rounded half up."""
    exact = np.multiply(a, b, dtype=np.int32)
    return ((exact + (1 << bits >> 1)) >> bits).astype(a.dtype)


def total(a: Integers, b: Integers) -> Integers:
    """MEAN (eq. 4) without its divisor, which divides N and S alike."""
    return a + b


def soft_min_1(a: Integers, b: Integers, *, table: Table) -> Integers:
    """Soft-min I (eq. 5): ``min(a, b) + g(|a - b|)``; it goes below zero where operands are 0."""
    return np.minimum(a, b) + _lookup(table, a, b)


def soft_min_2(a: Integers, b: Integers, *, table: Table, maximum: bool) -> Integers:
    """Soft-min II (eq. 6) of two operands: ``min + h(|a - b|)``, or ``max - h(|a - b|)`` for k < 0."""
    correction = _lookup(table, a, b)
    return np.maximum(a, b) - correction if maximum else np.minimum(a, b) + correction


def pair_operator(config: Config) -> PairTheta:
    """The configured operator on two operands; a rule's strength is ``Theta(a, Theta(b, c))``."""
    return FIXED[config.operator](config)


FIXED: Registry[Callable[[Config], PairTheta]] = Registry("operator in integers")
"""The operators by name: from a configuration to Theta of two operands."""

JOINED = frozenset({"soft_min_2"})
"""Those that are not monotone, and join rules before the outer Theta."""


def _soft_min_1_of(config: Config) -> PairTheta:
    return partial(soft_min_1, table=soft_min_1_table(config.one, config.softness))


def _soft_min_2_of(config: Config) -> PairTheta:
    table = soft_min_2_table(config.one, config.sharpness)
    return partial(soft_min_2, table=table, maximum=config.sharpness < 0)


FIXED.register("min", lambda _: minimum)
FIXED.register("prod", lambda config: partial(product, bits=config.membership_bits))
FIXED.register("mean", lambda _: total)
FIXED.register("soft_min_1", _soft_min_1_of)
FIXED.register("soft_min_2", _soft_min_2_of)


def conclude(config: Config, memberships: Sequence[Memberships]) -> Any:
    """``k, Y_k`` for k = 1..11: the maximum of the firing strength over the conclusion's rules that fire.

    Rules are evaluated one by one, except that soft-min II, which is not monotone, joins rules that agree
    in criterion 1 before the outer Theta: see `joined_conclusions`.
    """
    theta = pair_operator(config)
    if config.operator in JOINED:
        return joined_conclusions(memberships, theta, config.rules, config.firing)
    return conclusions(memberships, lambda a, b, c: theta(a, theta(b, c)), config.rules, config.firing)


def _lookup(table: Table, a: Integers, b: Integers) -> Integers:
    """The correction for ``|a - b|``; the table's last entry holds for all that is beyond it."""
    distance = np.minimum(np.abs(a - b), len(table) - 1)
    return np.array(table, a.dtype)[distance]
