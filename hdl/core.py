"""The stereo core: pixel pairs in, disparities out."""

from amaranth.hdl import Cat, Module, Mux, ResetSignal, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.fifo import SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, Word, travelling
from softdepth.hdl.built import check_built
from softdepth.hdl.costs.cost import fraction_layout
from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.costs.lane import Lane, column_layout
from softdepth.hdl.front.exclusion import Exclusion
from softdepth.hdl.front.frame_guard import FrameGuard, item_layout
from softdepth.hdl.front.item_queue import ItemQueue
from softdepth.hdl.front.line_buffer import LineBuffer
from softdepth.hdl.front.right_columns import RightColumns, candidate
from softdepth.hdl.front.sequencer import Sequencer, tags_layout
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.signatures import Status, pair_layout, result_layout
from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

FIFO_LATENCY = 2
"""Clocks from a write into the result FIFO to its output."""


class StereoCore(wiring.Component):
    """Streams a stereo pair in and one disparity per pixel out (Bobyr et al. 2021).

    ::

        i > frame guard > queue > sequencer > line buffer > right columns > lanes > argmin > results > o

    Throughput is one result every `Config.steps` clocks, without a pause between lines or frames.
    The pipeline itself never stalls: a pixel is admitted when a result has a place in the result
    FIFO, so back-pressure reaches the input and no further. The result of (x, y) follows the pixel
    at (x + reach_right, y + reach_rows), of which it is the last to need, by `latency` clocks where
    that pixel finds the core idle, and by `full_rate_latency` where pixels are always on offer: those
    wait in the queue for the steps of the pixels before them. Both are from the clock in which the
    pixel is taken to that in which the result can be. Results of a frame's last rows follow by themselves.

    During reset no pixel is taken: ``i.ready`` is low.

    Members
    -------
    i : stream of `pair_layout(config.pixel)`.
    o : stream of `result_layout(config)`, one result for each pixel, in the same order.
    status : counters of broken input.
    """

    def __init__(self, config: Config) -> None:
        check_built(config)
        self._config = config
        self._lanes = [Lane(config) for _ in range(config.lanes)]
        lane = self._lanes[0]
        num, den = (fraction_layout(config)[name].shape for name in ("num", "den"))
        self._best = candidate_layout(num, den, config.disparities)
        self._tree = ArgminTree(num, den, config.lanes)
        self._sequence = ArgminSequence(self._best, config.steps)

        # Clocks after the one in which the sequencer takes the pixel.
        self._column_time = LineBuffer.latency
        self._criteria_time = self._column_time + lane.criteria_latency
        self._cost_time = self._column_time + lane.latency
        self._winner_time = self._cost_time + self._tree.latency
        self._result_time = self._winner_time + self._sequence.latency
        promised = self._result_time + config.steps - 1 + FIFO_LATENCY
        self.latency = ItemQueue.latency + promised
        self.full_rate_latency = self.latency + ItemQueue.places * (config.steps - 1)
        self.fifo_depth = -(-(promised + 2) // config.steps) + 3
        super().__init__(
            {
                "i": In(stream.Signature(pair_layout(config.pixel))),
                "o": Out(stream.Signature(result_layout(config))),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        control = Pipeline(m, levels=1)

        m.submodules.guard = guard = FrameGuard(config)
        m.submodules.sequencer = sequencer = Sequencer(config)
        m.d.comb += [
            guard.i.valid.eq(self.i.valid),
            guard.i.payload.eq(self.i.payload),
            self.i.ready.eq(guard.i.ready & ~ResetSignal("sync")),
        ]
        m.submodules.queue = queue = ItemQueue(item_layout(config))
        wiring.connect(m, guard.o, queue.i)
        wiring.connect(m, queue.o, sequencer.i)
        m.d.comb += self.status.eq(guard.status)

        # Bits that say what happens are reset; what they speak of is not. Both start at clock 1.
        occurs: dict[str, list[Signal]] = {}
        first = Signal()
        m.d.comb += first.eq(sequencer.valid & sequencer.first)
        for name, source in {"valid": sequencer.valid, "first": first, "emit": sequencer.emit}.items():
            occurs[name] = [source, *travelling(m, source, self._result_time - 1, name, since=1)]
        step = control.input(sequencer.step, config.steps - 1, time=1)
        first_of_line = control.input(sequencer.first_of_line, 1, time=1)
        first_inner = control.input(sequencer.first_inner, 1, time=1)

        m.submodules.lines = lines = LineBuffer(2 * config.pixel.size, config.column_rows, config.max_width)
        item = queue.o.payload
        column = column_layout(config)
        left, right = Signal(column), Signal(column)
        m.d.comb += [
            lines.en.eq(sequencer.load),
            lines.x.eq(item.x),
            lines.pixel.eq(Cat(*self._moved(m, sequencer.load, item))),
            left.eq(Cat(lines.column[r][: config.pixel.size] for r in range(config.column_rows))),
            right.eq(Cat(lines.column[r][config.pixel.size :] for r in range(config.column_rows))),
        ]

        m.submodules.right = columns = RightColumns(config, column)
        m.d.comb += [
            columns.valid.eq(occurs["valid"][self._column_time]),
            columns.first.eq(occurs["first"][self._column_time]),
            columns.column.eq(right),
        ]

        # Where the step is in the line, all candidates counted.
        looked_up = self._column_time - LOOKUP_AHEAD
        place = Signal(range(config.places), reset_less=True)
        with m.If(occurs["valid"][looked_up - 1]):
            m.d.sync += place.eq(place + 1)
            begins = control.at(first_of_line, looked_up - 1).value
            with m.If(begins & occurs["first"][looked_up - 1]):
                m.d.sync += place.eq(0)

        m.submodules.tree = self._tree
        near = self._near(m, control.at(step, self._criteria_time - 1))
        m.submodules.exclusion = exclusion = Exclusion(config)
        judged = self._cost_time - Exclusion.latency
        m.d.comb += [
            exclusion.valid.eq(occurs["valid"][judged]),
            exclusion.first.eq(occurs["first"][judged]),
            exclusion.starts.eq(control.at(first_inner, judged).value),
        ]
        for k, lane in enumerate(self._lanes):
            m.submodules[f"lane_{k}"] = lane
            m.d.comb += [
                lane.valid.eq(occurs["valid"][self._column_time]),
                lane.coming.eq(occurs["valid"][looked_up]),
                lane.place.eq(place),
                lane.left.eq(left),
                lane.right.eq(columns.columns[k]),
                lane.near.eq(near[k]),
                self._tree.i[k].num.eq(lane.o.num),
                self._tree.i[k].den.eq(lane.o.den),
                self._tree.i[k].excluded.eq(exclusion.lanes[k]),
            ]

        m.submodules.sequence = sequence = self._sequence
        winner_step = control.at(step, self._winner_time).value
        winner = self._tree.o
        m.d.comb += [
            sequence.valid.eq(occurs["valid"][self._winner_time]),
            sequence.last.eq(winner_step == config.steps - 1),
            sequence.i.num.eq(winner.num),
            sequence.i.den.eq(winner.den),
            sequence.i.index.eq(winner.index * config.steps + (config.steps - 1 - winner_step)),
            sequence.i.excluded.eq(winner.excluded),
        ]

        m.submodules.tags = tags = Delay(tags_layout(), self._result_time - 1)
        m.d.comb += [tags.en.eq(1), tags.i.eq(sequencer.tags)]
        self._results(m, occurs["emit"][self._result_time], tags.o, sequencer)
        return m

    def _moved(self, m: Module, load: Signal, item: data.View) -> tuple[Value, Value]:
        """Left and right pixel, one of them late by `Config.min_disparity`: candidates then begin at 0.

        The late one's columns are those of the line, but for its first ones, which are the line's before:
        pixels that see them have no result.
        """
        shift = self._config.min_disparity
        m.submodules.late = late = Delay(self._config.pixel.size, abs(shift))
        m.d.comb += [late.en.eq(load), late.i.eq(item.left if shift < 0 else item.right)]
        return (late.o, item.right) if shift < 0 else (item.left, late.o)

    def _near(self, m: Module, step: Word) -> list[Signal]:
        """For each lane, one clock after ``step``: the compensating rule's bound is reached."""
        config = self._config
        near = []
        bound = config.compensation.from_disparity - config.min_disparity
        for lane in range(config.lanes):
            near.append(Signal(name=f"near_{lane}", reset_less=True))
            # The step's candidate is `farthest - step`.
            farthest = candidate(config, lane, 0)
            m.d.sync += near[lane].eq(step.value + bound <= farthest)
        return near

    def _results(self, m: Module, emit: Signal, tags: data.View, sequencer: Sequencer) -> None:
        """The result FIFO, and the credits that keep it from overflowing."""
        layout = result_layout(self._config)
        result = Signal(layout)
        m.d.comb += [
            result.disparity.eq(
                Mux(tags.code == Validity.BORDER, 0, self._sequence.o.index + self._config.min_disparity)
            ),
            *[result[name].eq(tags[name]) for name in ("code", "sof", "eol", "eof", "damaged")],
        ]
        m.submodules.results = fifo = SyncFIFOBuffered(width=layout.size, depth=self.fifo_depth)
        m.d.comb += [
            fifo.w_en.eq(emit),
            fifo.w_data.eq(result),
            self.o.valid.eq(fifo.r_rdy),
            self.o.payload.eq(fifo.r_data),
            fifo.r_en.eq(self.o.ready),
        ]
        credits_left = Signal(range(self.fifo_depth + 1), init=self.fifo_depth)
        returned = self.o.valid & self.o.ready
        m.d.sync += credits_left.eq(credits_left - sequencer.issued + returned)
        m.d.comb += sequencer.credit.eq(credits_left > 1)  # one in the next clock, at least
