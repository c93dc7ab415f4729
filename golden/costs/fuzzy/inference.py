"""Fuzzy rules (table 1), as printed: every rule is evaluated by itself, and nothing is shared among them."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.rules import Firing, RuleBaseName, rule_base

Array = NDArray[Any]
Theta = Callable[[Array, Array, Array], Array]
"""The operator of a rule: the memberships of criteria 1, 2, 3 to its firing strength."""
PairTheta = Callable[[Array, Array], Array]
"""An operator of two operands; of three by nesting."""
Memberships = tuple[Array, Array, Array]
"""One criterion's memberships: low (A1), middle (A2) and high (A3) dissimilarity."""
Mask = NDArray[np.bool_] | np.bool_


def conclusions(
    memberships: Sequence[Memberships], theta: Theta, rules: RuleBaseName, firing: Firing = "all"
) -> Iterator[tuple[int, Array]]:
    """``k, Y_k`` for k = 1..11: the maximum of the firing strengths of the rules of conclusion k.

    `memberships` holds those of criteria 1 to 3; all arrays, and the results, have one shape. With
    ``firing = "cell"`` only the rules count whose labels lie next to the criteria (`live_labels`);
    a conclusion that has none of them is 0.
    """
    first, second, third = memberships
    live = [live_labels(triple, firing) for triple in memberships]
    for k, members in rule_base(rules).items():
        yield (
            k,
            _strongest(
                (
                    theta(first[a - 1], second[b - 1], third[c - 1]),
                    live[0][a - 1] & live[1][b - 1] & live[2][c - 1],
                )
                for a, b, c in members
            ),
        )


def joined_conclusions(
    memberships: Sequence[Memberships], theta: PairTheta, rules: RuleBaseName, firing: Firing = "all"
) -> Iterator[tuple[int, Array]]:
    """``k, Y_k`` of an operator of two operands, the maximum taken before the outer Theta.

    ``Y_k`` is the maximum over the labels a of criterion 1 in conclusion k of
    ``Theta(A_a, max Theta(A_b, A_c))``, the inner maximum over k's rules that begin with a. For a
    monotone Theta this is what `conclusions` gives with ``Theta(a, Theta(b, c))``. Soft-min II is
    not monotone: for it this order is the definition. `firing` as in `conclusions`.
    """
    first, second, third = memberships
    live = [live_labels(triple, firing) for triple in memberships]
    for k, members in rule_base(rules).items():
        strengths = []
        for label in sorted({a for a, _, _ in members}):
            pairs = [(b - 1, c - 1) for a, b, c in members if a == label]
            masks = [live[1][b] & live[2][c] for b, c in pairs]
            pair = _strongest(
                (theta(second[b], third[c]), mask) for (b, c), mask in zip(pairs, masks, strict=True)
            )
            strengths.append(
                (theta(first[label - 1], pair), live[0][label - 1] & reduce(np.logical_or, masks))
            )
        yield k, _strongest(strengths)


def live_labels(memberships: Memberships, firing: Firing) -> tuple[Mask, Mask, Mask]:
    """Which labels of a criterion fire: all, or the two next to it (low and middle, or middle and high).

    Below T, and only there, the membership of the low label is above 0.
    """
    if firing == "all":
        return np.True_, np.True_, np.True_
    below = memberships[0] > 0
    return below, np.True_, ~below


def _strongest(strengths: Iterable[tuple[Array, Mask]]) -> Array:
    """The maximum over the strengths that count, and 0 where none does."""
    strongest: Array | None = None
    some_miss = False
    for strength, counts in strengths:
        if not np.all(counts):
            strength = np.where(counts, strength, _lowest(strength))
            some_miss = True
        strongest = strength if strongest is None else np.maximum(strongest, strength, out=strongest)
    assert strongest is not None  # every conclusion has a rule
    if some_miss:
        strongest[strongest == _lowest(strongest)] = 0
    return strongest


def _lowest(values: Array) -> Any:
    """Below any strength, in its type."""
    return -np.inf if values.dtype.kind == "f" else values.dtype.type(np.iinfo(values.dtype).min)
