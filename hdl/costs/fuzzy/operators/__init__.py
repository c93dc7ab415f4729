"""The fuzzy AND of a rule, Theta: one small unit per operator.

`OPERATORS` are for all 27 rules, whatever their memberships; `CELL_OPERATORS` for the eight of a cell.
MIN and PROD have no others: rules outside the cell have no strength.
"""

from collections.abc import Callable
from typing import Protocol

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.operators.cell import CellOperator
from softdepth.hdl.costs.fuzzy.operators.cell_mean import CellMean
from softdepth.hdl.costs.fuzzy.operators.mean import Mean
from softdepth.hdl.costs.fuzzy.operators.minimum import Minimum
from softdepth.hdl.costs.fuzzy.operators.product import Product
from softdepth.hdl.costs.fuzzy.operators.soft_extremum import SoftExtremum
from softdepth.hdl.costs.fuzzy.operators.soft_min_1 import SoftMin1
from softdepth.hdl.costs.fuzzy.operators.soft_min_2 import SoftMin2
from softdepth.spec.config import Config
from softdepth.spec.registry import Registry


class Operator(Protocol):
    """Theta in two halves, so that rules that share criteria 2 and 3 share the first.

    Both halves are monotone in every operand, and their results lie within `Config.strength_range`.
    """

    pair_operations: int
    """Operations in a row of `pair`."""
    fire_operations: int
    """Operations in a row of `fire`."""

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """The half that joins the memberships of criteria 2 and 3."""
        ...

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """The firing strength: criterion 1's membership joined with a pair."""
        ...


OPERATORS: Registry[Callable[[Config], Operator]] = Registry("operator's gateware")
"""The unit behind a value of `Config.operator` where all rules fire."""

CELL_OPERATORS: Registry[Callable[[Config], CellOperator]] = Registry("operator's gateware by cell")
"""The unit behind a value of `Config.operator` where the rules of a cell fire."""

OPERATORS.register("mean", Mean)
OPERATORS.register("soft_min_1", SoftMin1)
OPERATORS.register("soft_min_2", SoftMin2)
CELL_OPERATORS.register("min", Minimum)
CELL_OPERATORS.register("prod", Product)
CELL_OPERATORS.register("mean", CellMean)
CELL_OPERATORS.register("soft_min_1", SoftExtremum)
CELL_OPERATORS.register("soft_min_2", SoftExtremum)
