"""Where the pixel pairs come from: one AXI4-Stream of both views, or two that are joined."""

from amaranth.hdl import Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.pair_sync import PairSync, joined_layout
from softdepth.hdl.axi.tdata import pair_bits, pixel_of, view_bits
from softdepth.hdl.axi.view_queue import ViewQueue
from softdepth.hdl.signatures import COUNTER_BITS
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config

PREFIX = "s_axis"
VIEWS = ("left", "right")


def axi_stream(prefix: str, bits: int, flow: wiring.Flow) -> dict[str, wiring.Member]:
    """The ports of an AXI4-Stream Video interface, incoming or outgoing."""
    against = Out if flow is In else In
    return {
        f"{prefix}_tdata": flow(bits),
        f"{prefix}_tvalid": flow(1),
        f"{prefix}_tready": against(1),
        f"{prefix}_tuser": flow(1),
        f"{prefix}_tlast": flow(1),
    }


class OneStream(wiring.Component):
    """One stream with both views' pixels side by side. Wires only.

    Members
    -------
    s_axis_* : the stream.
    o : a stream of `joined_layout`, red lowest.
    """

    def __init__(self, config: Config) -> None:
        self._pixel = config.pixel
        joined = joined_layout(config.pixel.size)
        super().__init__(
            {**axi_stream(PREFIX, pair_bits(config.pixel), In), "o": Out(stream.Signature(joined))}
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        o, size = self.o.payload, self._pixel.size
        m.d.comb += [
            self.o.valid.eq(self.s_axis_tvalid),
            self.s_axis_tready.eq(self.o.ready),
            o.left.eq(pixel_of(self.s_axis_tdata[:size], self._pixel)),
            o.right.eq(pixel_of(self.s_axis_tdata[size : 2 * size], self._pixel)),
            o.sof.eq(self.s_axis_tuser),
            o.last.eq(self.s_axis_tlast),
        ]
        return m


class TwoStreams(wiring.Component):
    """One stream per view, each with a queue, joined by `PairSync`.

    Members
    -------
    s_axis_left_*, s_axis_right_* : the streams, including ``aclk`` where each has its own clock.
    o, by_count, between, clear, lost, losses : as in `PairSync`.
    waits : one view is held up because the other lags further behind than was allowed for.
    """

    def __init__(self, config: Config, options: AxiOptions) -> None:
        self._config, self._own_clocks = config, options.clocks == "own"
        self._depth = config.max_width * options.skew
        bits = view_bits(config.pixel)
        ports: dict[str, wiring.Member] = {}
        for view in VIEWS:
            if self._own_clocks:
                ports[f"{PREFIX}_{view}_aclk"] = In(1)
            ports |= axi_stream(f"{PREFIX}_{view}", bits, In)
        super().__init__(
            {
                **ports,
                "o": Out(stream.Signature(joined_layout(config.pixel.size))),
                **{name: In(1) for name in ("by_count", "between", "clear")},
                "lost": Out(1),
                "losses": Out(COUNTER_BITS),
                "waits": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pixel = self._config.pixel
        m.submodules.sync = sync = PairSync(
            pixel.size, skew=self._depth, most_pixels=self._config.max_width * self._config.max_height
        )
        queues: list[ViewQueue] = []
        for view in VIEWS:
            queue = ViewQueue(pixel.size, self._depth, own_clock=self._own_clocks)
            m.submodules[view] = queue
            queues.append(queue)

            def port(name: str, view: str = view) -> Signal:
                return getattr(self, f"{PREFIX}_{view}_{name}")

            if self._own_clocks:
                m.d.comb += queue.clk.eq(port("aclk"))
            m.d.comb += [
                queue.i.valid.eq(port("tvalid")),
                port("tready").eq(queue.i.ready),
                queue.i.payload.pixel.eq(pixel_of(port("tdata"), pixel)),
                queue.i.payload.sof.eq(port("tuser")),
                queue.i.payload.last.eq(port("tlast")),
            ]
            wiring.connect(m, queue.o, getattr(sync, view))
        wiring.connect(m, sync.o, wiring.flipped(self.o))
        m.d.comb += [
            *(getattr(sync, name).eq(getattr(self, name)) for name in ("by_count", "between", "clear")),
            self.lost.eq(sync.lost),
            self.losses.eq(sync.losses),
        ]
        left, right = queues
        m.d.sync += self.waits.eq((left.full & ~right.o.valid) | (right.full & ~left.o.valid))
        return m
