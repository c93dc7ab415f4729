"""Running sums along a row: each adds a column and drops one."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


class RowSum(wiring.Component):
    """The sum of a candidate's last ``columns`` column sums: two additions, however many there are.

    Column sums come step by step; those of the same candidate lie ``steps`` apart. Sums start from 0 with
    each line, so an upset bit does not last longer.

    Parameters
    ----------
    maximum : of a column sum.

    Members
    -------
    valid, column : a step's column sum.
    leaving : in the same clock, the column sum of ``columns`` slots before.
    begins : the step belongs to a line's first slot.
    full : the column that leaves is of the same line.
    o : the sum, `latency` clocks later.
    """

    latency = 2

    def __init__(self, maximum: int, columns: int, steps: int) -> None:
        self._steps = steps
        self.maximum = maximum * columns
        super().__init__(
            {
                "valid": In(1),
                "column": In(range(maximum + 1)),
                "leaving": In(range(maximum + 1)),
                "begins": In(1),
                "full": In(1),
                "o": Out(range(self.maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        left = self.leaving & self.full.replicate(len(self.leaving))
        change = Signal((self.column - left).shape(), reset_less=True)
        valid = Signal()
        begins = Signal(reset_less=True)
        m.d.sync += [change.eq(self.column - left), valid.eq(self.valid), begins.eq(self.begins)]
        sums = [Signal.like(self.o, name=f"sum_{k}", reset_less=True) for k in range(self._steps)]
        with m.If(valid):
            m.d.sync += [
                sums[0].eq(Mux(begins, 0, sums[-1]) + change),
                *(sums[k].eq(sums[k - 1]) for k in range(1, self._steps)),
            ]
        m.d.comb += self.o.eq(sums[0])
        return m
