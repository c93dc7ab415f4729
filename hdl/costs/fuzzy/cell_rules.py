"""What the rules of a cell have in common; `CellInference` is made of it."""

from itertools import product

from softdepth.spec.errors import ConfigError
from softdepth.spec.rules import RuleBaseName, rule_base

Rules = frozenset[tuple[int, int, int]]
Cell = tuple[bool, bool, bool]
"""Which of the three criteria are above T."""

_SIDES = (False, True)
_CELLS = [(a, b, c) for a in _SIDES for b in _SIDES for c in _SIDES]


def joins_corners(name: RuleBaseName) -> bool:
    """Whether the rule base has two conclusions that take in a corner of criteria 2 and 3.

    A cell has two labels of each criterion: of criterion 1 the middle and an outer one, of the others
    a lower and an upper one. Its rules are those of `cell_conclusions`, without such corners (the
    corrected table) or with them (the printed one). Raises `ConfigError` for a rule base that is
    neither: the gateware would compute something else.
    """
    for joins in (False, True):
        if all(cell_conclusions(upper, joins=joins) == _of_table(name, upper) for upper in _CELLS):
            return joins
    raise ConfigError(
        f"the rules '{name}' of a cell are not six conclusions of successive weights", "use firing = 'all'"
    )


def cell_conclusions(upper: Cell, *, joins: bool) -> dict[int, Rules]:
    """The rules of each conclusion that has any, in the cell above (`upper`) or below T of each criterion.

    Pairs of criteria 2 and 3 rank by their number of upper labels, 0 to 2, and criterion 1's outer
    label counts 3 more, or 3 less below T. If the rule base `joins`, then rank 1 takes in rank 0 for
    criterion 1's label high where the others are below T, and rank 2 for its label middle where they
    are above.
    """
    a_upper, b_upper, c_upper = upper
    found = {}
    for label in (2, 3 if a_upper else 1):
        ranks: list[set[tuple[int, int]]] = [set(), set(), set()]
        for b, c in product((0, 1), repeat=2):
            ranks[b + c].add((1 + b_upper + b, 1 + c_upper + c))
        if joins and label == 3 and not b_upper and not c_upper:
            ranks = [set(), ranks[0] | ranks[1], ranks[2]]
        if joins and label == 2 and b_upper and c_upper:
            ranks = [ranks[0], ranks[1] | ranks[2], set()]
        for rank, pairs in enumerate(ranks):
            weight = 3 * (label - 2) + b_upper + c_upper + rank - 2
            if pairs:
                found[6 - weight] = frozenset((label, b, c) for b, c in pairs)
    return found


def _of_table(name: RuleBaseName, upper: Cell) -> dict[int, Rules]:
    """The same from the rule base itself."""
    labels = [{1 + up, 2 + up} for up in upper]
    found = {
        k: frozenset(rule for rule in rules if all(x in near for x, near in zip(rule, labels, strict=True)))
        for k, rules in rule_base(name).items()
    }
    return {k: rules for k, rules in found.items() if rules}
