"""Pixels in, the costs of all candidates out, for criteria that have a border band."""

from amaranth.hdl import Cat, Module, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In

from softdepth.hdl.arithmetic.pipeline import Pipeline, travelling
from softdepth.hdl.costs.bundle import cost_ports
from softdepth.hdl.costs.cost import fraction_layout
from softdepth.hdl.costs.lane import Lane, column_layout
from softdepth.hdl.costs.near import near_lanes
from softdepth.hdl.front.exclusion import Exclusion
from softdepth.hdl.front.frame_guard import item_layout
from softdepth.hdl.front.line_buffer import LineBuffer
from softdepth.hdl.front.right_columns import RightColumns
from softdepth.hdl.front.sequencer import Sequencer, tags_layout
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.memory.item_queue import ItemQueue, places_for
from softdepth.spec.config import Config


def band_tags(config: Config) -> data.StructLayout:
    """The tags of a result: whether it leaves in this clock, and the sequencer's `tags_layout`."""
    return data.StructLayout({"emits": 1, "result": tags_layout()})


class BandCosts(wiring.Component):
    """Judges the candidates of every pixel, ``lanes`` a clock, by criteria over windows of pixels.

    ::

        i > queue > sequencer > line buffer > right columns > lanes > costs

    ``steps`` clocks a pixel, without a pause between lines or frames. The pipeline never stalls: a pixel is
    admitted if there is credit. Pixels whose support goes beyond the image have results without costs, which
    leave with the steps of other pixels, or on their own.

    Members
    -------
    places : pixels that wait for their beginning.
    i : the items of `FrameGuard`.
    The others : `cost_ports` of `fraction_layout` and `band_tags`.
    """

    waits = ItemQueue.latency
    """Clocks from a pixel's arrival to its beginning, at least."""
    tags_from_begin = 1
    """Clocks from a pixel's beginning to the tags of its first step."""

    def __init__(self, config: Config) -> None:
        self._config = config
        self.places = places_for(config.steps)
        self._lanes = [Lane(config) for _ in range(config.lanes)]
        lane = self._lanes[0]
        self._criteria_time = LineBuffer.latency + lane.criteria_latency
        self.latency = LineBuffer.latency + lane.latency
        self.tags_ahead = self.latency - self.tags_from_begin
        ports = cost_ports(
            lanes=config.lanes, steps=config.steps, cost=fraction_layout(config), tags=band_tags(config)
        )
        super().__init__({"i": In(stream.Signature(item_layout(config))), **ports})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        control = Pipeline(m, levels=1)
        m.submodules.sequencer = sequencer = Sequencer(config)
        # The sequencer decides late in its clock, by the pixel itself. Its answer must not travel on to the
        # front, which may be far away.
        m.submodules.arrived = arrived = ItemQueue(item_layout(config), places=self.places)
        wiring.connect(m, wiring.flipped(self.i), arrived.i)
        wiring.connect(m, arrived.o, sequencer.i)
        m.d.comb += [
            sequencer.credit.eq(self.credit),
            self.begins.eq(sequencer.issued),
            self.tags.emits.eq(sequencer.emit),
            self.tags.result.eq(sequencer.tags),
        ]

        # Clocks are counted from the one in which the sequencer takes a pixel; its outputs come at 1.
        column_time, cost_time = LineBuffer.latency, self.latency
        # Control bits are reset; the data that they qualify is not.
        occurs: dict[str, list[Signal]] = {}
        first = Signal()
        m.d.comb += first.eq(sequencer.valid & sequencer.first)
        for name, source in {"valid": sequencer.valid, "first": first}.items():
            occurs[name] = [source, *travelling(m, source, cost_time - 1, name, since=1)]
        step = control.input(sequencer.step, config.steps - 1, "step", time=1)
        first_of_line = control.input(sequencer.first_of_line, 1, "first_of_line", time=1)
        first_inner = control.input(sequencer.first_inner, 1, "first_inner", time=1)

        left, right = self._columns(m, sequencer.load, arrived.o.payload)
        m.submodules.right = columns = RightColumns(config, left.shape())
        m.d.comb += [
            columns.valid.eq(occurs["valid"][column_time]),
            columns.first.eq(occurs["first"][column_time]),
            columns.column.eq(right),
        ]

        # The step's place in the line, counting all candidates, as early as the lanes look it up.
        looked_up = column_time - self._lanes[0].look_ahead
        place = Signal(range(config.places), reset_less=True)
        with m.If(occurs["valid"][looked_up - 1]):
            m.d.sync += place.eq(place + 1)
            begins = control.at(first_of_line, looked_up - 1).value
            with m.If(begins & occurs["first"][looked_up - 1]):
                m.d.sync += place.eq(0)

        near = near_lanes(m, config, control.at(step, self._criteria_time - 1).value)
        m.submodules.exclusion = exclusion = Exclusion(config)
        judged = cost_time - Exclusion.latency
        m.d.comb += [
            exclusion.valid.eq(occurs["valid"][judged]),
            exclusion.first.eq(occurs["first"][judged]),
            exclusion.starts.eq(control.at(first_inner, judged).value),
            self.excluded.eq(exclusion.lanes),
        ]
        for k, lane in enumerate(self._lanes):
            m.submodules[f"lane_{k}"] = lane
            m.d.comb += [
                lane.valid.eq(occurs["valid"][column_time]),
                lane.coming.eq(occurs["valid"][looked_up]),
                lane.place.eq(place),
                lane.left.eq(left),
                lane.right.eq(columns.columns[k]),
                lane.near.eq(near[k]),
                self.costs[k].eq(lane.o),
            ]
        judged_step = control.at(step, cost_time).value
        m.d.comb += [
            self.valid.eq(occurs["valid"][cost_time]),
            self.first.eq(occurs["first"][cost_time]),
            self.last.eq(judged_step == config.steps - 1),
            self.step.eq(judged_step),
        ]
        return m

    def _columns(self, m: Module, load: Signal, item: data.View) -> tuple[data.View, data.View]:
        """Both views' columns, top row first."""
        config = self._config
        size = config.pixel.size
        m.submodules.lines = lines = LineBuffer(2 * size, config.column_rows, config.max_width)
        left = Signal(column_layout(config))
        right = Signal(column_layout(config))
        m.d.comb += [
            lines.en.eq(load),
            lines.x.eq(item.x),
            lines.pixel.eq(Cat(*self._moved(m, load, item))),
            left.eq(Cat(lines.column[row][:size] for row in range(config.column_rows))),
            right.eq(Cat(lines.column[row][size:] for row in range(config.column_rows))),
        ]
        return left, right

    def _moved(self, m: Module, load: Signal, item: data.View) -> tuple[Value, Value]:
        """Left and right pixel, one of them delayed by `Config.min_disparity`: candidates then begin at 0.

        The delayed view's columns are those of the line, except for the first ones, which are those of the
        line before. Pixels that see these have no result.
        """
        shift = self._config.min_disparity
        m.submodules.late = late = Delay(self._config.pixel.size, abs(shift))
        m.d.comb += [late.en.eq(load), late.i.eq(item.left if shift < 0 else item.right)]
        return (late.o, item.right) if shift < 0 else (item.left, late.o)
