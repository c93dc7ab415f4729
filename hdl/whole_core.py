"""The stereo core for criteria that need no border band."""

from amaranth.hdl import Module, ResetSignal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.comparison import LIKE_BITS, plan
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.hdl.front.descriptors import Descriptors
from softdepth.hdl.front.frame_ends import FrameEnds
from softdepth.hdl.front.frame_guard import FrameGuard, item_layout
from softdepth.hdl.front.item_queue import ItemQueue
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.median import Median
from softdepth.hdl.signatures import Status, pair_layout, result_layout
from softdepth.hdl.winners.whole_winners import WholeWinners
from softdepth.spec.config import Config
from softdepth.spec.criteria import Gradient
from softdepth.spec.post import MEDIAN_REACH


class WholeFrameCore(wiring.Component):
    """Streams a stereo pair in and a result for every pixel out, by criteria such as census and gradient.

    ::

        i > frame guard > queue > frame ends > descriptors > costs > winners > post stages > o

    A result every ``steps`` clocks within a line. Each stage that looks beyond the frame's edge holds its
    input back at the ends of lines and frames for as many columns and rows as it looks ahead; of these,
    those of the costs alone take ``steps`` clocks each. Back-pressure passes from stage to stage, and never
    into one. A frame's last result leaves without waiting for the next frame.

    Members
    -------
    i : stream of `pair_layout(config.pixel)`.
    o : stream of `result_layout(config)`, one result for each pixel, in the same order.
    status : counters of broken input.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "i": In(stream.Signature(pair_layout(config.pixel))),
                "o": Out(stream.Signature(result_layout(config))),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config, post = self._config, self._config.post
        m.submodules.guard = guard = FrameGuard(config)
        m.submodules.queue = queue = ItemQueue(item_layout(config))
        m.submodules.ends = ends = FrameEnds(config)
        m.d.comb += [
            guard.i.valid.eq(self.i.valid),
            guard.i.payload.eq(self.i.payload),
            self.i.ready.eq(guard.i.ready & ~ResetSignal("sync")),
        ]
        wiring.connect(m, guard.o, queue.i)
        wiring.connect(m, queue.o, ends.i)
        m.d.comb += self.status.eq(guard.status)

        comparisons = plan(config).comparisons
        caps = {c.field: c.criterion.cap for c in comparisons if isinstance(c.criterion, Gradient)}
        m.submodules.descriptors = descriptors = Descriptors(
            config.pixel.channels,
            config.pixel.bits,
            config.max_width,
            census=len(caps) < len(comparisons),
            caps=caps,
        )
        wiring.connect(m, ends.o, descriptors.i)

        drain = config.disparities - 1 if post.check else 0
        m.submodules.costs = costs = WholeCosts(
            config, descriptors.layout, config.pixel.channels, drain=drain
        )
        wiring.connect(m, descriptors.o, costs.i)
        m.submodules.winners = winners = WholeWinners(config, costs.maximum, config.pixel.size, costs.latency)
        m.d.comb += [
            costs.credit.eq(winners.credit),
            winners.begins.eq(costs.begins),
            *(
                Value.cast(getattr(winners, name)).eq(Value.cast(getattr(costs, name)))
                for name in ("valid", "first", "last", "step", "costs", "excluded", "tags")
            ),
        ]

        results = winners.o
        for name, stage in self._stages().items():
            m.submodules[name] = stage
            wiring.connect(m, results, stage.i)
            results = stage.o
        o = self.o.payload
        m.d.comb += [
            self.o.valid.eq(results.valid),
            results.ready.eq(self.o.ready),
            o.disparity.eq(results.payload.value),
            o.code.eq(results.payload.code),
            *(o[marker].eq(results.payload[marker]) for marker in MARKERS),
        ]
        if post.confidence:
            m.d.comb += o.confidence.eq(results.payload.confidence)
        return m

    def _stages(self) -> dict[str, Island | Fill | Median]:
        """The stages behind the winners, in their order."""
        config, post = self._config, self._config.post
        size = (config.result_bits, config.pixel.size)
        holes = not post.fill
        stages: dict[str, Island | Fill | Median] = {}
        if post.island:
            stages["island"] = Island(*size, config.max_width, post.island)
        if post.fill:
            stages["fill"] = Fill(*size, config.max_width)
        if post.median:
            stages["median"] = Median(
                *size,
                config.pixel.channels,
                config.max_width,
                rows=MEDIAN_REACH,
                columns=MEDIAN_REACH,
                holes=holes,
            )
        if reach := post.masked_median:
            for name, rows, columns in (("along_row", 0, reach), ("down_column", reach, 0)):
                stages[name] = Median(
                    *size,
                    config.pixel.channels,
                    config.max_width,
                    rows=rows,
                    columns=columns,
                    like=post.like << (config.pixel.bits - LIKE_BITS),
                    holes=holes,
                )
        return stages
