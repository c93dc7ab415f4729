"""The stereo core: pixel pairs in, disparities out."""

from contextlib import nullcontext

from amaranth.hdl import Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.built import check_built
from softdepth.hdl.costs.bundle import join
from softdepth.hdl.left_pixels import LeftPixels
from softdepth.hdl.memory.kept import Kept
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.stages import post_stages
from softdepth.hdl.rooms import costs_of, front_of, winners_of
from softdepth.hdl.signatures import (
    STEERING,
    Status,
    pair_layout,
    result_layout,
    settings_ports,
    thresholds_layout,
)
from softdepth.hdl.thresholds import told
from softdepth.hdl.winners.whole_winners import WholeWinners
from softdepth.spec.config import Config


class StereoCore(wiring.Component):
    """Streams a stereo pair in and one result for every pixel out (Bobyr et al. 2021, and beyond).

    ::

        i > front > costs > winners > post stages > o

    Between front and costs, and behind the winners, there are streams: back-pressure passes from one to the
    next and never into one. Costs and winners are one pipeline that never stalls (`cost_ports`): the winners
    give credit where a result has a place in their queue. Each room states its own latency, from which
    its neighbours' alignment and queues follow.

    Throughput is one result every `Config.steps` clocks within a line. With criteria that have a border
    band there is no pause between lines or frames either; where there is none, each stage that looks
    beyond the frame's edge holds its input back at the ends of lines and frames, for as many columns and rows
    as it looks ahead (those of the costs take ``steps`` clocks each). A frame's last results leave
    without waiting for the next frame. During reset no pixel is taken: ``i.ready`` is low.

    `BandLatency` states by how many clocks a result follows the last pixel that it needs in a core with a
    border band, `WholeLatency` in the others.

    Raises `ConfigError` for a configuration that has a model but no gateware.

    Parameters
    ----------
    settings : it is told thresholds while it runs.
    left : each result carries its pixel of the left view, as it was judged: in mended frames a mended one.

    Members
    -------
    i : stream of `pair_layout(config.pixel)`.
    o : stream of `result_layout`, one result for each pixel, in the same order.
    status : counters of broken input.
    settings, faults : with ``settings``, what `settings_layout` says, and the faults of the clock before.
    """

    def __init__(self, config: Config, *, settings: bool = False, left: bool = False) -> None:
        check_built(config)
        self._config, self._takes_settings = config, settings
        self._left = LeftPixels.of(config) if left else None
        self._front = front_of(
            config, left=self._left.places if self._left and self._left.origin == "guard" else 0
        )
        with told(thresholds_layout(config)) if settings else nullcontext() as thresholds:
            self._costs = costs_of(config, self._front.layout)
            self._winners = winners_of(config, self._costs)
            self._post = post_stages(config)
        self._thresholds = thresholds or {}
        super().__init__(
            {
                "i": In(stream.Signature(pair_layout(config.pixel))),
                "o": Out(stream.Signature(result_layout(config, left=left))),
                "status": Out(Status),
                **(settings_ports(config) if settings else {}),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.front, m.submodules.costs, m.submodules.winners = self._front, self._costs, self._winners
        wiring.connect(m, wiring.flipped(self.i), self._front.i)
        wiring.connect(m, self._front.o, self._costs.i)
        join(m, self._costs, self._winners)
        results = self._winners.o
        kept = self._front.kept if self._left and self._left.origin == "guard" else None
        for name, stage in self._post.items():
            m.submodules[name] = stage
            if self._left and self._left.origin == name:
                m.submodules.left = left = Kept(results.payload.shape(), "colour", self._left.places)
                wiring.connect(m, results, left.i)
                results, kept = left.o, left.kept
            wiring.connect(m, results, stage.i)
            results = stage.o
        if self._takes_settings:
            self._set(m)
        found, o = results.payload, self.o.payload
        m.d.comb += [
            self.status.eq(self._front.status),
            self.o.valid.eq(results.valid),
            results.ready.eq(self.o.ready),
            o.disparity.eq(found.value),
            *(o[name].eq(found[name]) for name in o.shape().members if name not in ("disparity", "left")),
        ]
        if kept is not None:
            m.d.comb += [
                self.o.valid.eq(results.valid & kept.valid),
                results.ready.eq(self.o.ready & kept.valid),
                kept.ready.eq(self.o.ready & results.valid),
                o.left.eq(kept.payload),
            ]
        elif self._left:
            m.d.comb += o.left.eq(found.colour)
        return m

    def _set(self, m: Module) -> None:
        """Thresholds are those that the settings say, and not the configuration's."""
        settings, post = self.settings, self._config.post
        m.d.comb += self.faults.eq(self._front.faults)
        m.d.comb += [getattr(self._front, name).eq(settings[name]) for name in STEERING]
        m.d.comb += [signal.eq(settings[name]) for name, signal in self._thresholds.items()]
        if post.check and isinstance(self._winners, WholeWinners):
            m.d.comb += self._winners.tolerance.eq(settings.tolerance)
        island = self._post.get("island")
        if isinstance(island, Island):
            m.d.comb += island.least.eq(settings.island)
