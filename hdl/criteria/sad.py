"""SAD criteria: sums of absolute RGB differences over windows (Bobyr et al. 2021, eq. 7)."""

from collections.abc import Sequence

from amaranth.hdl import Module, Mux, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.config import CHANNEL_BITS, CHANNELS, Config, Sad
from softdepth.hdl.box_sum import BoxSum, box_latency
from softdepth.hdl.delay import Delay
from softdepth.hdl.pipeline import Pipeline, Word, travelling, tree_latency

CHANNEL_MAXIMUM = 2**CHANNEL_BITS - 1


class SadCriteria(wiring.Component):
    """All SAD criteria of one lane, one candidate per clock.

    Windows of one centre share their absolute differences: a column of the largest window is
    computed once, summed outwards for each window's height, and boxed along the row. Criteria
    that look right wait for their columns, the others are held back, so that all leave together.

    Parameters
    ----------
    config : the core's configuration.
    criteria : the SAD criteria among its criteria, in order.

    Members
    -------
    valid : the columns are a step of a pixel.
    left, right : the columns to compare, ``2 * reach_rows + 1`` pixels from the top.
    o : the sums, ``latency`` clocks later, in the order of ``criteria``. They belong to the pixel
        `Config.reach_right` columns before the one that entered.
    """

    def __init__(self, config: Config, criteria: Sequence[Sad]) -> None:
        self._config = config
        self._criteria = criteria
        self._windows = sorted({criterion.window for criterion in criteria})
        self._column_latency = _column_latency(self._windows)
        self.latency = self._column_latency + max(box_latency(w) for w in self._windows)
        pixel = data.ArrayLayout(CHANNEL_BITS, CHANNELS)
        column = data.ArrayLayout(pixel, config.min_height)
        super().__init__(
            {
                "valid": In(1),
                "left": In(column),
                "right": In(column),
                "o": Out(data.StructLayout({f"s{i}": range(c.maximum + 1) for i, c in enumerate(criteria)})),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        valid = travelling(m, self.valid, self.latency, "valid")

        sums: dict[int, Word] = {}
        for window, column in self._column_costs(pipeline).items():
            m.submodules[f"box_{window}"] = box = BoxSum(column.maximum, window, self._config.steps)
            m.d.comb += [box.valid.eq(valid[column.time]), box.i.eq(column.value)]
            total = pipeline.input(box.o, box.maximum, time=column.time + box.latency)
            sums[window] = pipeline.at(total, self.latency)

        for i, criterion in enumerate(self._criteria):
            ahead = criterion.radius + criterion.dx
            pixels = self._config.reach_right - ahead
            m.submodules[f"hold_{i}"] = hold = Delay(
                sums[criterion.window].value.shape(), pixels * self._config.steps
            )
            m.d.comb += [
                hold.en.eq(valid[self.latency]),
                hold.i.eq(sums[criterion.window].value),
                self.o[f"s{i}"].eq(hold.o),
            ]
        return m

    def _column_costs(self, pipeline: Pipeline) -> dict[int, Word]:
        """The cost of one column for each window height, all at the same clock."""
        middle = self._config.reach_rows

        def row(offset: int) -> list[Word]:
            pixels = self.left[middle + offset], self.right[middle + offset]
            return [
                pipeline.register(absolute_difference(pixels[0][c], pixels[1][c]), 0, CHANNEL_MAXIMUM, 0)
                for c in range(CHANNELS)
            ]

        costs: dict[int, Word] = {}
        inner = -1  # the largest row offset that is summed already
        for window in self._windows:
            rows = [offset for offset in range(-(window // 2), window // 2 + 1) if abs(offset) > inner]
            added = pipeline.sum([word for offset in rows for word in row(offset)])
            costs[window] = pipeline.add(costs[max(costs)], added) if costs else added
            inner = window // 2
        return {w: pipeline.at(cost, self._column_latency) for w, cost in costs.items()}


def absolute_difference(a: Value, b: Value) -> Value:
    """``|a - b|`` of two unsigned values."""
    return Mux(a > b, a - b, b - a)[: len(a)]


def _column_latency(windows: Sequence[int]) -> int:
    latency, inner = 0, 0
    for window in windows:
        added = 1 + tree_latency((window - inner) * CHANNELS)
        latency = max(latency, added) + 1 if inner else added
        inner = window
    return latency
