"""Fuzzy rules (table 1), as printed: every rule is evaluated, and nothing is shared among them."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.rules import RuleBaseName, rule_base

Array = NDArray[Any]
Theta = Callable[[Array, Array, Array], Array]
"""The operator of a rule: the memberships of criteria 1, 2, 3 to its firing strength."""
PairTheta = Callable[[Array, Array], Array]
"""An operator of two operands; of three by nesting."""
Memberships = tuple[Array, Array, Array]
"""One criterion's memberships: low (A1), middle (A2) and high (A3) dissimilarity."""


def conclusions(
    memberships: Sequence[Memberships], theta: Theta, rules: RuleBaseName
) -> Iterator[tuple[int, Array]]:
    """``k, Y_k`` for k = 1..11: the maximum of the firing strengths of the rules of conclusion k.

    `memberships` holds those of criteria 1 to 3; all arrays, and the results, have one shape.
    """
    first, second, third = memberships
    for k, members in rule_base(rules).items():
        strongest, *others = (theta(first[a - 1], second[b - 1], third[c - 1]) for a, b, c in members)
        for strength in others:
            np.maximum(strongest, strength, out=strongest)
        yield k, strongest


def joined_conclusions(
    memberships: Sequence[Memberships], theta: PairTheta, rules: RuleBaseName
) -> Iterator[tuple[int, Array]]:
    """``k, Y_k`` of an operator of two operands, the maximum taken before the outer Theta.

    ``Y_k`` is the maximum over the labels a of criterion 1 in conclusion k of
    ``Theta(A_a, max Theta(A_b, A_c))``, the inner maximum over k's rules that begin with a. For a
    monotone Theta this is what `conclusions` gives with ``Theta(a, Theta(b, c))``. Soft-min II is
    not monotone: for it this order is the definition.
    """
    first, second, third = memberships
    for k, members in rule_base(rules).items():
        strengths = []
        for label in sorted({a for a, _, _ in members}):
            pairs = [theta(second[b - 1], third[c - 1]) for a, b, c in members if a == label]
            strengths.append(theta(first[label - 1], np.maximum.reduce(pairs)))
        yield k, np.maximum.reduce(strengths)
