"""Descriptors in, the costs of all candidates out, for criteria that are summed down columns."""

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In

from softdepth.hdl.arithmetic.colour import coarse
from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.costs.border import in_border
from softdepth.hdl.costs.bundle import cost_ports
from softdepth.hdl.costs.column_groups import join_columns
from softdepth.hdl.costs.comparison import LIKE_BITS, plan
from softdepth.hdl.costs.criteria.running_sums import RunningSums
from softdepth.hdl.costs.criteria.support import SupportWeights
from softdepth.hdl.costs.near import near_lanes
from softdepth.hdl.costs.whole_lane import (
    LaneDifferences,
    LaneSums,
    inside_layout,
    inside_of,
    row_of,
    rows_layout,
    supports_layout,
)
from softdepth.hdl.front.exclusion import Exclusion
from softdepth.hdl.front.right_columns import RightColumns
from softdepth.hdl.front.slots import Slots
from softdepth.hdl.memory.delay import Delay, delayed
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.signatures import colour_size
from softdepth.spec.config import Config

COLUMN_TIME = 2
"""Clocks from a slot's first step to its columns, which have a long way to all the lanes; besides, a running
sum is looked up before its columns are compared."""

DEEP_RING = 3
"""From this many places on, a lane's ring of right columns is distributed RAM, because flip-flops run out
first."""


def tags_layout(config: Config) -> data.StructLayout:
    """About the pixel that a slot judges: whether there is one, whether it is in the border band, whether it
    has all its candidates; and its colour."""
    return data.StructLayout(
        {
            "emits": 1,
            "border": int(not config.whole_frame),
            "full": 1,
            "colour": colour_size(config),
            **dict.fromkeys(MARKERS, 1),
        }
    )


class WholeCosts(wiring.Component):
    """Judges the candidates of every pixel, ``lanes`` a clock, by criteria that are summed down columns.

    ::

        i > slots > right columns > differences > running sums > supports, boxes > sum or inference > costs

    A slot of ``steps`` clocks for each pixel, and more slots beyond the ends of lines and frames (`Slots`).
    What lies outside the frame counts 0, and a candidate without a partner a constant. If a criterion has a
    border band, pixels in it have no candidates, and others only those whose partner is outside the band.

    Candidates begin at 0: a configuration with others is made `from_zero` and sees the views' `Overlap`.

    Members
    -------
    i : the raster of `Descriptors`.
    The others : `cost_ports`, with `tags_layout` through all steps of a slot.
    """

    def __init__(self, config: Config, descriptors: data.StructLayout, channels: int, *, drain: int) -> None:
        self._config, self._descriptors, self._channels = config, descriptors, channels
        self._plan = plan(config)
        self._sums = [LaneSums(config, self._plan) for _ in range(config.lanes)]
        self.layout = self._sums[0].layout
        self._drain = drain
        self._colour_bits = descriptors["colour"].width
        tags = tags_layout(config)
        super().__init__(
            {
                "i": In(stream.Signature(descriptors)),
                **cost_ports(lanes=config.lanes, steps=config.steps, cost=self.layout, tags=tags),
            }
        )

    waits = 2 * ItemQueue.latency
    """Clocks from a pixel's arrival to its slot's beginning, at least."""

    @property
    def latency(self) -> int:
        """Clocks from a slot's beginning to its first costs."""
        return Slots.latency + COLUMN_TIME + self._sum_after_columns + self._sums[0].latency

    @property
    def _sum_after_columns(self) -> int:
        return LaneDifferences.latency - RunningSums.ahead + RunningSums.latency

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config, plan_ = self._config, self._plan
        members = {k: v for k, v in self._descriptors.members.items() if k not in MARKERS}
        payload = data.StructLayout(members)
        m.submodules.slots = slots = Slots(
            payload,
            config.steps,
            config.max_width,
            right=plan_.right,
            below=plan_.below,
            history=plan_.history,
            drain=self._drain,
            first=config.reach_left,
        )
        # The slots' decision comes late in its clock and must not go on to the output of a wide queue, which
        # is far away: so there are places at both ends.
        m.submodules.arrived = arrived = ItemQueue(self._descriptors)
        m.submodules.places = places = ItemQueue(self._descriptors)
        wiring.connect(m, wiring.flipped(self.i), arrived.i)
        wiring.connect(m, arrived.o, places.i)
        m.d.comb += [
            slots.i.valid.eq(places.o.valid),
            places.o.ready.eq(slots.i.ready),
            slots.i.payload.as_value().eq(places.o.payload.as_value()),
            slots.credit.eq(self.credit),
            self.begins.eq(slots.begins),
        ]
        slot = slots.slot

        # Clocks after the one in which a step leaves the slots.
        column_time = COLUMN_TIME
        place_time = column_time + LaneDifferences.latency - RunningSums.ahead
        sum_time = column_time + self._sum_after_columns
        cost_time = sum_time + self._sums[0].latency
        valid = travelling(m, slots.valid, cost_time, "valid")
        first = travelling(m, slots.first, cost_time, "first")
        last = travelling(m, slots.last, cost_time, "last")

        def at(value: Value, clock: int, name: str) -> Value:
            return delayed(m, value, clock, name)

        # A pixel's column in both views: all rows that are compared.
        row_layout = rows_layout(plan_)
        left = Signal(row_layout)
        right = Signal(row_layout)
        for view, columns in (("left", left), ("right", right)):
            held = at(Value.cast(slot.payload[view]), column_time, view)
            fields = data.View(self._descriptors[view].shape, held)
            for field, rows in plan_.rows.items():
                for k, lag in enumerate(rows):
                    m.d.comb += Value.cast(columns[row_of(field, lag)]).eq(Value.cast(fields[field][k]))
        in_memory = config.steps - 1 >= DEEP_RING
        m.submodules.right = ring = RightColumns(config, row_layout, registers=False if in_memory else None)
        m.d.comb += [
            ring.valid.eq(valid[column_time]),
            ring.first.eq(first[column_time]),
            ring.column.eq(right),
        ]

        # Which candidates have no partner, and later, which are excluded.
        m.submodules.absent = absent = Exclusion(config)
        before = column_time + 1 - Exclusion.latency
        m.d.comb += [
            absent.valid.eq(valid[before]),
            absent.first.eq(first[before]),
            absent.starts.eq(at(slot.first_column, before, "first_column")),
        ]
        m.submodules.exclusion = exclusion = Exclusion(config)
        before = cost_time - Exclusion.latency
        m.d.comb += [
            exclusion.valid.eq(valid[before]),
            exclusion.first.eq(first[before]),
            exclusion.starts.eq(at(slot.starts, before, "starts")),
        ]

        place = Signal(range(config.places), reset_less=True)
        with m.If(valid[place_time - 1]):
            m.d.sync += place.eq(place + 1)
            with m.If(first[place_time - 1] & at(slot.first_column, place_time - 1, "line")):
                m.d.sync += place.eq(0)
        rows_of = at(Value.cast(slot.rows), column_time + 1, "rows")
        column_inside = at(slot.inside, column_time + 1, "column")
        top = at(slot.top, place_time, "top")
        outside = at(~slot.inside, place_time, "outside")

        colour = at(Value.cast(slot.payload.colour), column_time, "colour")
        inside = at(slot.inside, column_time, "in")
        supports = Signal(supports_layout(plan_))
        self._weights(m, colour, first[column_time], inside, supports)
        border = in_border(m, self._config, plan_, slots)
        centre = self._centre(m, colour, first[column_time])
        rows_inside = Signal(inside_layout(plan_))
        for running, lag in sorted({(c.running, lag) for c in plan_.columns for lag in c.lags}):
            # Beyond the frame's columns it is the running sum that is held back, not its differences.
            within = rows_of[lag] if running else rows_of[lag] & column_inside
            m.d.comb += rows_inside[inside_of(lag, running)].eq(within)
        differences = []
        for k in range(config.lanes):
            m.submodules[f"differences_{k}"] = lane = LaneDifferences(plan_)
            differences.append(lane)
            m.d.comb += [
                lane.left.eq(left),
                lane.right.eq(ring.columns[k]),
                lane.absent.eq(absent.lanes[k]),
                lane.inside.eq(rows_inside),
            ]
        line_begins = at(slot.first_column, sum_time, "line_begins")
        full = [
            at(slot.x > 2 * c.reach, sum_time, f"full_{j}") if plan_.row_runs(c) else Const(0, 1)
            for j, c in enumerate(plan_.comparisons)
        ]
        judged = at(slot.emits & ~border, cost_time, "judged")
        step = at(slots.step, cost_time, "step")
        near = near_lanes(m, config, at(slots.step, sum_time + self._sums[0].criteria_latency - 1, "near"))
        join_columns(
            m,
            config,
            plan_,
            differences,
            self._sums,
            valid=valid[place_time],
            place=place,
            begins=top,
            outside=outside,
            summed=valid[sum_time],
        )
        for k, sums in enumerate(self._sums):
            m.submodules[f"sums_{k}"] = sums
            m.d.comb += [
                sums.valid.eq(valid[sum_time]),
                sums.begins.eq(line_begins),
                sums.full.eq(Cat(*full)),
                sums.supports.eq(supports),
                sums.near.eq(near[k]),
                self.costs[k].eq(sums.o),
                self.excluded[k].eq(exclusion.lanes[k] | ~judged),
            ]

        tags = Signal(self.tags.shape())
        m.d.comb += [
            tags.emits.eq(slot.emits),
            tags.border.eq(border),
            tags.full.eq(slot.x >= plan_.right + config.reach_left + config.disparities - 1),
            *(tags[name].eq(slot[name]) for name in MARKERS),
        ]
        m.d.comb += [
            self.valid.eq(valid[cost_time]),
            self.first.eq(first[cost_time]),
            self.last.eq(last[cost_time]),
            self.step.eq(step),
            Value.cast(self.tags).eq(at(Value.cast(tags), cost_time, "tags")),
            self.tags.colour.eq(at(centre, cost_time - column_time - 1, "centre")),
        ]
        return m

    def _weights(self, m: Module, colour: Value, enters: Value, inside: Value, supports: data.View) -> None:
        """The supports of the pixel that is judged, in the clock of the newest of its column sums."""
        for k, c in enumerate(self._plan.comparisons):
            if not c.taps:
                continue
            like = c.like << (self._config.pixel.bits - LIKE_BITS)
            m.submodules[f"weights_{k}"] = weights = SupportWeights(
                self._colour_bits, self._channels, c.taps, c.spacing, like
            )
            m.submodules[f"wait_{k}"] = wait = Delay(self._colour_bits + 1, self._plan.right - c.reach)
            m.d.comb += [
                wait.en.eq(enters),
                wait.i.eq(colour | (inside << self._colour_bits)),
                weights.enters.eq(enters),
                weights.colour.eq(wait.o[: self._colour_bits]),
                weights.inside.eq(wait.o[self._colour_bits]),
                supports[str(k)].weights.eq(weights.weights),
                supports[str(k)].reciprocal.eq(weights.reciprocal),
            ]

    def _centre(self, m: Module, colour: Value, enters: Value) -> Value:
        """The judged pixel's colour in `Config.colour_bits`, from a clock after its slot's columns on."""
        colour = coarse(colour, self._channels, self._config.colour_bits)
        m.submodules.colours = colours = Delay(len(colour), self._plan.right)
        centre = Signal(len(colour), name="centre", reset_less=True)
        m.d.comb += [colours.en.eq(enters), colours.i.eq(colour)]
        with m.If(enters):
            m.d.sync += centre.eq(colours.o)
        return centre
