"""How often which kind of broken input was met."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.signatures import COUNTER_BITS, Faults, Status


class FaultCounters(wiring.Component):
    """A saturating counter for each member of `Status`.

    A fault is counted two clocks after it is reported: a clock for the report to travel, so that counters
    lie on nobody's longest path, and one for the counter itself.

    Members
    -------
    short_lines, long_lines, early_starts, missing_starts : such a fault is met in this clock.
    again : what is reported in this clock will be reported again, and counts then.
    clear : the counters begin at 0.
    met : the faults of the clock before.
    status : the counters since reset; they stay at their greatest value.
    """

    latency = 2

    def __init__(self) -> None:
        super().__init__(
            {
                **{name: In(1) for name in Status.members},
                "again": In(1),
                "clear": In(1),
                "met": Out(Faults),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        again = Signal()
        m.d.sync += again.eq(self.again)
        for name in Status.members:
            met = Signal(name=f"met_{name}")
            counter = self.status[name]
            m.d.sync += met.eq(getattr(self, name))
            fault = Signal(name=f"fault_{name}")
            m.d.comb += [fault.eq(met & ~again), self.met[name].eq(fault)]
            with m.If(fault & (counter != 2**COUNTER_BITS - 1)):
                m.d.sync += counter.eq(counter + 1)
            with m.If(self.clear):
                m.d.sync += counter.eq(0)
        return m
