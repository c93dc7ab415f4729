"""SAD criteria: sums of absolute differences over windows (Bobyr et al. 2021, eq. 7)."""

from collections.abc import Sequence

from amaranth.hdl import Module

from softdepth.hdl.arithmetic.pipeline import Pipeline, travelling
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.criteria.box_sum import BoxSum
from softdepth.hdl.costs.criteria.column_sad import ColumnSad, column_maximum
from softdepth.hdl.costs.criteria.criterion import CriterionBlock
from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.memory.delay import Delay
from softdepth.spec.config import Config, Sad


class SadCriteria(CriterionBlock):
    """All SAD criteria of one lane, with the ports of `CriterionBlock`.

    Windows of one centre share their absolute differences: a column of the largest window is
    computed once, summed outwards for each window's height, and boxed along the row. Criteria
    that look right wait for their columns, and the others are delayed to leave together with them.
    The columns to compare are as high as the largest window without its stored rows.
    """

    look_ahead = LOOKUP_AHEAD

    def __init__(self, config: Config, criteria: Sequence[Sad]) -> None:
        self._config = config
        self._criteria = criteria
        self._windows = sorted({criterion.window for criterion in criteria})
        self._column = ColumnSad(self._windows, config.pixel, config.stored_rows, config.places)
        self._boxes = {w: BoxSum(column_maximum(w, config.pixel), w, config.steps) for w in self._windows}
        self.latency = self._column.latency + max(box.latency for box in self._boxes.values())
        super().__init__(config, criteria, self._windows[-1] - config.stored_rows)

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
