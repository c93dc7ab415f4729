"""The two halves of a lane whose criteria have no border band: before the column sums and behind them."""

from amaranth.hdl import Module, Value, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, tree_latency
from softdepth.hdl.costs.comparison import Plan
from softdepth.hdl.costs.criteria.row_box import RowBox
from softdepth.hdl.costs.criteria.support import SupportMean
from softdepth.hdl.costs.criteria.unlikeness import Hamming
from softdepth.hdl.memory.delay import Delay


def rows_layout(plan: Plan) -> data.StructLayout:
    """Of each criterion the descriptor that enters its sums and the one that leaves them."""
    return data.StructLayout({str(k): data.ArrayLayout(c.shape, 2) for k, c in enumerate(plan.comparisons)})


def pixels_layout(plan: Plan) -> data.StructLayout:
    """Of each criterion a pixel's difference."""
    return data.StructLayout({str(k): range(c.pixel_maximum + 1) for k, c in enumerate(plan.comparisons)})


def columns_layout(plan: Plan) -> data.StructLayout:
    """Of each criterion a column's sum."""
    return data.StructLayout({str(k): range(c.column_maximum + 1) for k, c in enumerate(plan.comparisons)})


class LaneDifferences(wiring.Component):
    """A candidate's differences in the row that enters the sums and in the one that leaves them.

    Members
    -------
    left, right : descriptors of both rows.
    absent : one clock later: the candidate has no partner.
    new_inside, old_inside : one clock later, a bit a criterion: the row lies in the frame.
    new, old : the differences, `latency` clocks after the descriptors.
    """

    latency = Hamming.latency

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        rows, pixels = rows_layout(plan), pixels_layout(plan)
        count = len(plan.comparisons)
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
        for k, comparison in enumerate(self._plan.comparisons):
            for row, (name, inside) in enumerate((("new", self.new_inside), ("old", self.old_inside))):
                m.submodules[f"{name}_{k}"] = difference = comparison.differences()
                m.d.comb += [
                    difference.a.eq(self.left[str(k)][row]),
                    difference.b.eq(self.right[str(k)][row]),
                    difference.absent.eq(self.absent),
                    difference.inside.eq(inside[k]),
                    getattr(self, name)[str(k)].eq(difference.o),
                ]
        return m


class LaneSums(wiring.Component):
    """A candidate's cost: the sum of its criteria, each from column sums that come step by step.

    Members
    -------
    valid, columns : a step's column sums.
    weights, reciprocal : in the same clock, of the pixel that is judged, ``plan.right`` columns to the left.
    o : its cost, `latency` clocks later.
    """

    def __init__(self, plan: Plan, steps: int) -> None:
        self._plan, self._steps = plan, steps
        self._parts: list[tuple[SupportMean | RowBox, int, int]] = []  # block, slots to wait, factor
        supports: list[SupportMean] = []
        for c in plan.comparisons:
            if c.taps:
                block: SupportMean | RowBox = SupportMean(c.column_maximum, c.taps, c.spacing, steps)
                supports.append(block)
                self._parts.append((block, plan.right - c.reach, 0))
            else:
                block = RowBox(c.column_maximum, 2 * c.reach + 1, plan.right - c.reach, steps)
                self._parts.append((block, 0, c.own_shift))
        self.maximum = sum(block.maximum << shift for block, _, shift in self._parts)
        self.latency = max(block.latency for block, _, _ in self._parts) + tree_latency(len(self._parts))
        support = supports[-1] if supports else None
        super().__init__(
            {
                "valid": In(1),
                "columns": In(columns_layout(plan)),
                "weights": In(support.weights.shape() if support else 0),
                "reciprocal": In(support.reciprocal.shape() if support else 0),
                "o": Out(unsigned(self.maximum.bit_length())),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m, levels=1)
        words = []
        for k, (block, wait, shift) in enumerate(self._parts):
            m.submodules[f"criterion_{k}"] = block
            column: Value = self.columns[str(k)]
            if wait:
                m.submodules[f"wait_{k}"] = delay = Delay(column.shape(), wait * self._steps)
                m.d.comb += [delay.en.eq(self.valid), delay.i.eq(column)]
                column = delay.o
            m.d.comb += [block.valid.eq(self.valid), block.column.eq(column)]
            if isinstance(block, SupportMean):
                m.d.comb += [block.weights.eq(self.weights), block.reciprocal.eq(self.reciprocal)]
            words.append(pipeline.input(block.o << shift, block.maximum << shift, time=block.latency))
        start = max(word.time for word in words)
        total = pipeline.sum([pipeline.at(word, start) for word in words])
        m.d.comb += self.o.eq(pipeline.at(total, self.latency).value)
        return m
