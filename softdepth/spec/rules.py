"""The rule base: which conclusion each of the 27 rules belongs to (Bobyr et al. 2021, table 1).

A rule names the label of each of the three criteria: 1 = low, 2 = middle, 3 = high dissimilarity.
Conclusion ``Y_k`` is the maximum over its rules of the firing strength; ``Y_11`` (all low) is the
best match. Both models and the gateware read the same table; how they evaluate it is up to
them.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

RuleBase = Mapping[int, tuple[tuple[int, int, int], ...]]
RuleBaseName = Literal["printed", "corrected"]
Firing = Literal["all", "cell"]
"""Which rules count: all 27, or the eight whose labels are next to the three criteria."""

CONCLUSIONS = 11


def _table(text: str) -> RuleBase:
    rows = (line.split() for line in text.strip().splitlines())
    parse = lambda rule: (int(rule[0]), int(rule[1]), int(rule[2]))  # noqa: E731
    return MappingProxyType({int(k): tuple(map(parse, rules)) for k, *rules in rows})


PRINTED = _table("""
    1  333
    2  332 323
    3  331 322 313
    4  311 312 321
    5  223 232 233
    6  213 222 231
    7  133 212 221
    8  123 132 211
    9  113 122 131
    10 112 121
    11 111
""")
"""Table 1 as printed."""

CORRECTED = _table("""
    1  333
    2  332 323
    3  331 322 313
    4  233 312 321
    5  223 232 311
    6  213 222 231
    7  133 212 221
    8  123 132 211
    9  113 122 131
    10 112 121
    11 111
""")
"""Table 1 with rules 311 and 233 exchanged, so that every class follows one weighting."""


def rule_base(name: RuleBaseName) -> RuleBase:
    """The rules of each conclusion ``1..11``, as label triples of criteria 1 to 3."""
    return CORRECTED if name == "corrected" else PRINTED


def weight(conclusion: int) -> int:
    """Output label ``M_k``: falls linearly from 5 (``Y_1``, worst) to -5 (``Y_11``, best).

    Any affine change of the weights leaves the argmin unchanged; centred ones are the smallest.
    """
    return (CONCLUSIONS + 1) // 2 - conclusion
