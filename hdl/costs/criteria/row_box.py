"""Sums along a row of column sums."""

from amaranth.hdl import Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, tree_operations
from softdepth.hdl.memory.delay import Delay


class RowBox(wiring.Component):
    """The sum of a candidate's last ``columns`` column sums, without those that came ``lag`` columns later.

    Column sums come step by step; those of the same candidate lie ``steps`` apart.

    Parameters
    ----------
    maximum : of a column sum.

    Members
    -------
    valid, column : a step's column sum.
    o : the sum, `latency` clocks later.
    """

    def __init__(self, maximum: int, columns: int, lag: int, steps: int) -> None:
        self._maximum, self._columns, self._lag, self._steps = maximum, columns, lag, steps
        self.latency = clocks(tree_operations(columns), levels=1)
        self.maximum = maximum * columns
        super().__init__(
            {"valid": In(1), "column": In(range(maximum + 1)), "o": Out(range(self.maximum + 1))}
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        value: Value = self.column
        columns: list[Value] = []
        for k in range(self._columns):
            apart = self._steps if k else self._steps * self._lag
            # Registers, however many: a ring in memory needs a counter, and so three times the logic.
            m.submodules[f"delay_{k}"] = delay = Delay(self.column.shape(), apart, registers=True)
            m.d.comb += [delay.en.eq(self.valid), delay.i.eq(value)]
            value = delay.o
            columns.append(value)
        pipeline = Pipeline(m, levels=1)
        total = pipeline.sum([pipeline.input(column, self._maximum, "column") for column in columns])
        m.d.comb += self.o.eq(total.value)
        return m
