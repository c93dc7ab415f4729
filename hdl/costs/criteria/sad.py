"""SAD criteria: sums of absolute differences over windows (Bobyr et al. 2021, eq. 7)."""

from collections.abc import Sequence

from amaranth.hdl import Module
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, travelling
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.costs.criteria.box_sum import BoxSum
from softdepth.hdl.costs.criteria.column_sad import ColumnSad, column_maximum
from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.signatures import pixel_layout
from softdepth.spec.config import Config, Sad


class SadCriteria(wiring.Component):
    """All SAD criteria of one lane, one candidate per clock.

    Windows of one centre share their absolute differences: a column of the largest window is
    computed once, summed outwards for each window's height, and boxed along the row. Criteria
    that look right wait for their columns, and the others are delayed to leave together with them.

    Parameters
    ----------
    config : the core's configuration.
    criteria : the SAD criteria among its criteria, in order.

    Members
    -------
    valid : the columns are a step of a pixel.
    coming, place : the columns that come in `look_ahead` clocks are a step; which one of the line's.
    left, right : the columns to compare, from the top: the largest window without its stored rows.
    o : the sums, ``latency`` clocks later, in the order of ``criteria``. They belong to the pixel
        `Config.window_right` columns before the one that entered.
    """

    look_ahead = LOOKUP_AHEAD

    def __init__(self, config: Config, criteria: Sequence[Sad]) -> None:
        self._config = config
        self._criteria = criteria
        self._windows = sorted({criterion.window for criterion in criteria})
        self._column = ColumnSad(self._windows, config.pixel, config.stored_rows, config.places)
        self._boxes = {w: BoxSum(column_maximum(w, config.pixel), w, config.steps) for w in self._windows}
        self.latency = self._column.latency + max(box.latency for box in self._boxes.values())
        column = data.ArrayLayout(pixel_layout(config.pixel), self._windows[-1] - config.stored_rows)
        super().__init__(
            {
                "valid": In(1),
                "coming": In(1),
                "place": In(range(config.places)),
                "left": In(column),
                "right": In(column),
                "o": Out(criteria_layout(c.maximum_of(config.pixel) for c in criteria)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m, levels=1)
        valid = travelling(m, self.valid, self.latency, "valid")

        sums: dict[int, Word] = {}
        m.submodules.column = column = self._column
        m.d.comb += [
            column.valid.eq(self.coming),
            column.place.eq(self.place),
            column.left.eq(self.left),
            column.right.eq(self.right),
        ]
        for window in self._windows:
            m.submodules[f"box_{window}"] = box = self._boxes[window]
            m.d.comb += [box.valid.eq(valid[column.latency]), box.i.eq(column.o[f"c{window}"])]
            total = pipeline.input(box.o, box.maximum, "box", time=column.latency + box.latency)
            sums[window] = pipeline.at(total, self.latency)

        for i, criterion in enumerate(self._criteria):
            ahead = criterion.radius + criterion.dx
            pixels = self._config.window_right - ahead
            m.submodules[f"hold_{i}"] = hold = Delay(
                sums[criterion.window].value.shape(), pixels * self._config.steps
            )
            m.d.comb += [
                hold.en.eq(valid[self.latency]),
                hold.i.eq(sums[criterion.window].value),
                self.o[f"s{i}"].eq(hold.o),
            ]
        return m
