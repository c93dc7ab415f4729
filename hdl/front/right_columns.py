"""The right image's recent columns, handed to the lanes candidate by candidate."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import Delay
from softdepth.spec.config import Config


def candidate(config: Config, lane: int, step: int) -> int:
    """The disparity that ``lane`` evaluates at ``step`` of a pixel: lanes hold segments, far end first."""
    return lane * config.steps + config.steps - 1 - step


class RightColumns(wiring.Component):
    """Gives every lane the right column ``x - candidate(lane, step)`` of the current step.

    The last ``disparities`` columns lie in one segment of ``steps`` columns per lane. A segment is a
    ring of ``steps - 1`` places that turns once per pixel, plus one place in which the oldest
    column waits for the next lane: no multiplexer but the ring's own, whatever the number of lanes, and
    none at all with two steps or one.

    Parameters
    ----------
    registers : of the rings, as of `Delay`.

    Members
    -------
    valid : a step is taken.
    first : it is the pixel's first; never without ``valid``.
    column : the pixel's own right column, held through its steps.
    columns : one column a lane, in the same clock.
    """

    def __init__(self, config: Config, column: ShapeLike, *, registers: bool | None = None) -> None:
        self._config, self._registers = config, registers
        self._column = column
        super().__init__(
            {
                "valid": In(1),
                "first": In(1),
                "column": In(column),
                "columns": Out(data.ArrayLayout(column, config.lanes)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        entering = self.column
        for lane in range(self._config.lanes):
            current = Signal(self._column, name=f"current_{lane}")
            m.submodules[f"ring_{lane}"] = ring = Delay(
                self._column, self._config.steps - 1, registers=self._registers
            )
            m.submodules[f"wait_{lane}"] = wait = Delay(self._column, 1)
            m.d.comb += [
                current.eq(ring.o),
                wait.en.eq(self.first),
                wait.i.eq(current),
                self.columns[lane].eq(current),
            ]
            if (
                self._config.steps <= 2
            ):  # nothing to turn: a wire, or one place that takes a column or holds it
                m.d.comb += [ring.en.eq(self.first), ring.i.eq(entering)]
            else:
                m.d.comb += [ring.en.eq(self.valid), ring.i.eq(Mux(self.first, entering, current))]
            entering = wait.o
        return m
