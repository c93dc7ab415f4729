"""Puts the results of the columns in which the views overlap into the whole frame."""

from amaranth.hdl import Module, Mux, Shape, Signal
from amaranth.lib import data, stream
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.post.stage import PostStage, StageTime
from softdepth.hdl.winners.layout import post_layout
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def placed_layout(config: Config) -> data.StructLayout:
    """`post_layout` without a colour, with the true disparities."""
    members = dict(post_layout(config.result_bits, 0).members)
    return data.StructLayout(members | {"value": Shape(config.result_bits, signed=config.signed)})


class Placed(PostStage):
    """Adds `Config.min_disparity` to each value, and border results for the columns beside the overlap.

    Border results come before a line's results if `Config.min_disparity` is positive, and after them if it
    is negative. One result a clock.

    Members
    -------
    i : results of ``layout``, a `post_layout` of the configuration that is `from_zero`.
    o : results, `placed_layout`.
    """

    def __init__(self, config: Config, layout: data.StructLayout) -> None:
        self._config = config
        super().__init__(
            {"i": In(stream.Signature(layout)), "o": Out(stream.Signature(placed_layout(config)))}
        )

    @property
    def time(self) -> StageTime:
        return StageTime(max(-self._config.min_disparity, 0))  # border results that follow a line's last one

    def elaborate(self, platform: object) -> Module:
        m = Module()
        shift = self._config.min_disparity
        columns, behind = abs(shift), shift < 0
        result, o = self.i.payload, self.o.payload
        border = Signal(range(columns + 1), init=0 if behind else columns)  # results still to come
        bare = Signal()
        last = Signal()  # behind a line: the frame's last
        damaged = Signal()
        none = (Validity.BORDER, Validity.INCONSISTENT, Validity.ISLAND, Validity.NOTHING)
        given = Signal()
        taken = Signal()
        m.d.comb += [
            bare.eq(border != 0),
            given.eq(~bare),
            taken.eq(self.o.valid & self.o.ready),
            o.code.eq(Mux(bare, Validity.BORDER, result.code)),
            o.confidence.eq(Mux(bare, 0, result.confidence)),
        ]
        with m.Switch(result.code), m.Case(*none):
            m.d.comb += given.eq(0)
        m.d.comb += o.value.eq(Mux(given, result.value + (shift << self._config.post.fraction_bits), 0))
        if behind:
            m.d.comb += [
                self.o.valid.eq(bare | self.i.valid),
                self.i.ready.eq(~bare & self.o.ready),
                o.sof.eq(~bare & result.sof),
                o.eol.eq(border == 1),
                o.eof.eq((border == 1) & last),
                o.damaged.eq(Mux(bare, damaged, result.damaged)),
            ]
            with m.If(taken & bare):
                m.d.sync += border.eq(border - 1)
            with m.Elif(taken):
                m.d.sync += [damaged.eq(result.damaged), last.eq(result.eof)]
                with m.If(result.eol):
                    m.d.sync += border.eq(columns)
            return m
        first = Signal()
        m.d.comb += [
            first.eq(border == columns),
            self.o.valid.eq(self.i.valid),
            self.i.ready.eq(~bare & self.o.ready),
            *(o[name].eq(~bare & result[name]) for name in MARKERS),
            o.sof.eq(first & result.sof),
            o.damaged.eq(result.damaged),
        ]
        with m.If(taken):
            m.d.sync += border.eq(Mux(bare, border - 1, Mux(result.eol, columns, 0)))
        return m
