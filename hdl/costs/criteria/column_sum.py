"""Sums down columns whose rows are all compared anew."""

from amaranth.hdl import Module, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.adders import Field, add_fields
from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline
from softdepth.hdl.costs.criteria.running_sums import RunningSums


class ColumnSum(wiring.Component):
    """The sum of a column's differences: no memory, but logic that grows with the rows. One a clock.

    At most 16 rows: their additions fit into the clocks that a running sum takes.

    Parameters
    ----------
    maximum : the largest of each difference.
    rows : how many there are.

    Members
    -------
    i : the differences.
    o : their sum, `latency` clocks later.
    """

    latency = RunningSums.latency - RunningSums.ahead

    def __init__(self, maximum: int, rows: int) -> None:
        self._maximum = maximum
        super().__init__(
            {
                "i": In(data.ArrayLayout(unsigned(maximum.bit_length()), rows)),
                "o": Out(range(rows * maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        words = [pipeline.input(value, self._maximum, "pixel") for value in self.i]
        while len(words) > 1:
            pairs = [Field(a, b) for a, b in zip(words[::2], words[1::2], strict=False)]
            single = words[2 * len(pairs) :]
            words = add_fields(pairs)
            words += [pipeline.at(word, words[0].time) for word in single]
        m.d.comb += self.o.eq(pipeline.at(words[0], self.latency * LEVELS).value)
        return m
