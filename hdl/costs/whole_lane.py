"""The two halves of a lane whose criteria are summed down columns: before the column sums and behind them."""

from amaranth.hdl import Module, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, tree_operations
from softdepth.hdl.costs.comparison import Comparison, Plan
from softdepth.hdl.costs.cost import FuzzyCost, fraction_layout
from softdepth.hdl.costs.criteria.row_box import RowBox
from softdepth.hdl.costs.criteria.support import SupportMean, support_layout
from softdepth.hdl.costs.criteria.unlikeness import Hamming
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.winners.shapes import sum_layout
from softdepth.spec.config import Config


def row_of(field: str, lag: int) -> str:
    """The member of `rows_layout` for a descriptor of the row so far above the newest."""
    return f"{field}_{lag}"


def rows_layout(plan: Plan) -> data.StructLayout:
    """Of each criterion the descriptor that enters its sums and the one that leaves them, each once."""
    return data.StructLayout(
        {row_of(c.field, lag): c.shape for c in plan.comparisons for lag in (c.new, c.old)}
    )


def pixels_layout(plan: Plan) -> data.StructLayout:
    """Of each column that is summed a pixel's difference."""
    return data.StructLayout({str(k): range(c.pixel_maximum + 1) for k, c in enumerate(plan.columns)})


def columns_layout(plan: Plan) -> data.StructLayout:
    """Of each its sum."""
    return data.StructLayout({str(k): range(c.column_maximum + 1) for k, c in enumerate(plan.columns)})


def supports_layout(plan: Plan) -> data.StructLayout:
    """Of each criterion that has a support, by its number: `support_layout`."""
    taps = {str(k): c.taps for k, c in enumerate(plan.comparisons)}
    return data.StructLayout({k: support_layout(count) for k, count in taps.items() if count})


class LaneDifferences(wiring.Component):
    """A candidate's differences in the row that enters the sums and in the one that leaves them.

    Members
    -------
    left, right : descriptors of both rows.
    absent : one clock later: the candidate has no partner.
    new_inside, old_inside : one clock later, a bit a column: the row lies in the frame.
    new, old : the differences, `latency` clocks after the descriptors.
    """

    latency = Hamming.latency

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        rows, pixels = rows_layout(plan), pixels_layout(plan)
        count = len(plan.columns)
        super().__init__(
            {
                "left": In(rows),
                "right": In(rows),
                "absent": In(1),
                "new_inside": In(count),
                "old_inside": In(count),
                "new": Out(pixels),
                "old": Out(pixels),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for k, comparison in enumerate(self._plan.columns):
            ends = (("new", comparison.new, self.new_inside), ("old", comparison.old, self.old_inside))
            for name, lag, inside in ends:
                row = row_of(comparison.field, lag)
                m.submodules[f"{name}_{k}"] = difference = comparison.differences()
                m.d.comb += [
                    difference.a.eq(self.left[row]),
                    difference.b.eq(self.right[row]),
                    difference.absent.eq(self.absent),
                    difference.inside.eq(inside[k]),
                    getattr(self, name)[str(k)].eq(difference.o),
                ]
        return m


class LaneSums(wiring.Component):
    """A candidate's cost, from column sums that come step by step: its criteria's sum, or their inference.

    Members
    -------
    valid, columns : a step's column sums.
    supports : in the same clock, of the pixel that is judged, ``plan.right`` columns to the left.
    near : of the inference, `criteria_latency` clocks later.
    o : its cost, ``num / den``, `latency` clocks later.
    """

    def __init__(self, config: Config, plan: Plan) -> None:
        self._config, self._plan = config, plan
        self._parts = [self._part(c) for c in plan.comparisons]
        self.criteria_latency = max(block.latency for block, _, _ in self._parts)
        self._cost: FuzzyCost | None = None
        if config.cost == "fuzzy":
            self._cost = FuzzyCost(config)
            self.latency = self.criteria_latency + self._cost.latency
            self.layout = fraction_layout(config)
        else:
            self.latency = self.criteria_latency + clocks(tree_operations(len(self._parts)), levels=1)
            self.layout = sum_layout(sum(block.maximum << shift for block, _, shift in self._parts))
        super().__init__(
            {
                "valid": In(1),
                "columns": In(columns_layout(plan)),
                "supports": In(supports_layout(plan)),
                "near": In(1),
                "o": Out(self.layout),
            }
        )

    def _part(self, c: Comparison) -> tuple[SupportMean | RowBox, int, int]:
        """What makes a criterion of its columns, the slots that they wait, and bits to shift it by."""
        steps, wait = self._config.steps, self._plan.right - c.ahead
        if c.taps:
            return SupportMean(c.column_maximum, c.taps, c.spacing, steps), wait, 0
        return RowBox(c.column_maximum, 2 * c.reach + 1, wait, steps), 0, c.own_shift

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m, levels=1)
        words = []
        for k, (comparison, (block, wait, shift)) in enumerate(
            zip(self._plan.comparisons, self._parts, strict=True)
        ):
            m.submodules[f"criterion_{k}"] = block
            column: Value = self.columns[self._plan.column_of(comparison)]
            if wait:
                m.submodules[f"wait_{k}"] = delay = Delay(column.shape(), wait * self._config.steps)
                m.d.comb += [delay.en.eq(self.valid), delay.i.eq(column)]
                column = delay.o
            m.d.comb += [block.valid.eq(self.valid), block.column.eq(column)]
            if isinstance(block, SupportMean):
                support = self.supports[str(k)]
                m.d.comb += [block.weights.eq(support.weights), block.reciprocal.eq(support.reciprocal)]
            words.append(pipeline.input(block.o << shift, block.maximum << shift, time=block.latency))
        aligned = [pipeline.at(word, self.criteria_latency) for word in words]
        if self._cost is None:
            m.d.comb += self.o.num.eq(pipeline.at(pipeline.sum(aligned), self.latency).value)
            return m
        m.submodules.cost = self._cost
        m.d.comb += [
            self._cost.near.eq(self.near),
            *(self._cost.i[f"s{k}"].eq(word.value) for k, word in enumerate(aligned)),
            self.o.eq(self._cost.o),
        ]
        return m
