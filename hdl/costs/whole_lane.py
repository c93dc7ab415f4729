"""The two halves of a lane whose criteria are summed down columns: before the column sums and after them."""

from amaranth.hdl import Module, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, tree_operations
from softdepth.hdl.costs.comparison import Comparison, Plan
from softdepth.hdl.costs.cost import FuzzyCost, fraction_layout
from softdepth.hdl.costs.criteria.row_box import RowBox
from softdepth.hdl.costs.criteria.row_sum import RowSum
from softdepth.hdl.costs.criteria.support import SupportMean, support_layout
from softdepth.hdl.costs.criteria.unlikeness import Hamming
from softdepth.hdl.costs.layout import sum_layout
from softdepth.hdl.memory.delay import Delay
from softdepth.spec.config import Config


def row_of(field: str, lag: int) -> str:
    """The member of `rows_layout` for a descriptor of the row that lies `lag` above the newest."""
    return f"{field}_{lag}"


def rows_layout(plan: Plan) -> data.StructLayout:
    """Each criterion's descriptors of all rows that are compared, each once."""
    return data.StructLayout({row_of(c.field, lag): c.shape for c in plan.comparisons for lag in c.lags})


def inside_of(lag: int, running: bool) -> str:
    """The member of `inside_layout` for differences of this row, in running sums or in others."""
    return f"{'running' if running else 'anew'}_{lag}"


def inside_layout(plan: Plan) -> data.StructLayout:
    """For each row that is compared, whether it lies in the frame: each bit once, as columns share rows."""
    return data.StructLayout({inside_of(lag, c.running): 1 for c in plan.columns for lag in c.lags})


def pixels_layout(plan: Plan) -> data.StructLayout:
    """For each of the plan's columns, by number, the differences of its rows."""
    fields = {
        str(k): data.ArrayLayout(unsigned(c.pixel_maximum.bit_length()), len(c.lags))
        for k, c in enumerate(plan.columns)
    }
    return data.StructLayout(fields)


def columns_layout(plan: Plan) -> data.StructLayout:
    """For each of the plan's columns, by number, its sum."""
    return data.StructLayout({str(k): range(c.column_maximum + 1) for k, c in enumerate(plan.columns)})


def leaving_layout(plan: Plan) -> data.StructLayout:
    """For each criterion with a running sum along the row, by its number: a column's sum."""
    running = {str(k): c for k, c in enumerate(plan.comparisons) if plan.row_runs(c)}
    return data.StructLayout({k: range(c.column_maximum + 1) for k, c in running.items()})


def supports_layout(plan: Plan) -> data.StructLayout:
    """For each criterion with a support, by its number: `support_layout`."""
    taps = {str(k): c.taps for k, c in enumerate(plan.comparisons)}
    return data.StructLayout({k: support_layout(count) for k, count in taps.items() if count})


class LaneDifferences(wiring.Component):
    """A candidate's differences in all rows that are compared.

    Members
    -------
    left, right : their descriptors, `rows_layout`.
    absent : one clock later: the candidate has no partner.
    inside : one clock later, `inside_layout`: what lies outside the frame differs by 0.
    o : the differences, `pixels_layout`, `latency` clocks after the descriptors.
    """

    latency = Hamming.latency

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        rows = rows_layout(plan)
        super().__init__(
            {
                "left": In(rows),
                "right": In(rows),
                "absent": In(1),
                "inside": In(inside_layout(plan)),
                "o": Out(pixels_layout(plan)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for k, comparison in enumerate(self._plan.columns):
            for place, lag in enumerate(comparison.lags):
                row = row_of(comparison.field, lag)
                m.submodules[f"row_{lag}_{k}"] = difference = comparison.differences()
                m.d.comb += [
                    difference.a.eq(self.left[row]),
                    difference.b.eq(self.right[row]),
                    difference.absent.eq(self.absent),
                    difference.inside.eq(self.inside[inside_of(lag, comparison.running)]),
                    self.o[str(k)][place].eq(difference.o),
                ]
        return m


class LaneSums(wiring.Component):
    """A candidate's cost, from column sums that come step by step: its criteria's sum, or their inference.

    Members
    -------
    valid, columns : a step's column sums.
    leaving, begins, full : in the same clock, for running sums along the row, as in `RowSum`.
    supports : in the same clock, for the pixel that is judged, ``plan.right`` columns to the left.
    near : for the inference, `criteria_latency` clocks later.
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
                "leaving": In(leaving_layout(plan)),
                "begins": In(1),
                "full": In(len(plan.comparisons)),
                "supports": In(supports_layout(plan)),
                "near": In(1),
                "o": Out(self.layout),
            }
        )

    def _part(self, c: Comparison) -> tuple[SupportMean | RowBox | RowSum, int, int]:
        """The part that makes its columns a criterion, the slots they wait, and the bits to shift it by."""
        steps, wait = self._config.steps, self._plan.right - c.ahead
        if c.taps:
            return SupportMean(c.column_maximum, c.taps, c.spacing, steps), wait, 0
        if self._plan.row_runs(c):
            return RowSum(c.column_maximum, 2 * c.reach + 1, steps), 0, c.own_shift
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
            if isinstance(block, RowSum):
                m.d.comb += [
                    block.leaving.eq(self.leaving[str(k)]),
                    block.begins.eq(self.begins),
                    block.full.eq(self.full[k]),
                ]
            if isinstance(block, SupportMean):
                support = self.supports[str(k)]
                m.d.comb += [block.weights.eq(support.weights), block.reciprocal.eq(support.reciprocal)]
            words.append(
                pipeline.input(block.o << shift, block.maximum << shift, f"criterion_{k}", time=block.latency)
            )
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
