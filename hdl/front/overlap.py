"""Candidates that do not begin at 0, brought back to those that do, in the columns that the views share."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.memory.window import MARKERS, raster_layout
from softdepth.spec.config import Config


def from_zero(config: Config) -> Config:
    """The method with candidates from 0 on, as it sees the views behind `Overlap`."""
    shift, rule = config.min_disparity, config.compensation
    if not shift:
        return config
    moved = rule.model_copy(update={"from_disparity": rule.from_disparity - shift})
    return config.model_copy(update={"min_disparity": 0, "compensation": moved})


class Overlap(wiring.Component):
    """Moves one view along the lines by `Config.min_disparity`, and drops what has lost its partner.

    If it is positive, the right view moves, otherwise the left one; pairs begin with the line's pixel of that
    number. Lines are longer than that (`Config.min_width`). A pixel a clock, none held.

    Members
    -------
    i, o : `raster_layout` of both views' pixels, left lowest; the frames that leave are narrower.
    """

    def __init__(self, config: Config) -> None:
        self._size, self._shift = config.pixel.size, config.min_disparity
        layout = raster_layout(2 * self._size)
        super().__init__({"i": In(stream.Signature(layout)), "o": Out(stream.Signature(layout))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        item, columns = self.i.payload, abs(self._shift)
        left, right = item.element[: self._size], item.element[self._size :]
        late = left if self._shift < 0 else right
        dropped = Signal(range(columns + 1))  # of the line so far
        within = Signal()
        starts = Signal()  # the frame's first pixel was dropped
        taken = Signal()
        m.submodules.late = delay = Delay(self._size, columns)
        m.d.comb += [
            within.eq(dropped == columns),
            taken.eq(self.i.valid & self.i.ready),
            delay.en.eq(taken),
            delay.i.eq(late),
            self.o.valid.eq(self.i.valid & within),
            self.i.ready.eq(self.o.ready | ~within),
            self.o.payload.element.eq(Cat(delay.o, right) if self._shift < 0 else Cat(left, delay.o)),
            *(self.o.payload[name].eq(item[name]) for name in MARKERS),
            self.o.payload.sof.eq(starts),
        ]
        with m.If(taken):
            m.d.sync += [
                dropped.eq(Mux(item.eol, 0, dropped + ~within)),
                starts.eq(~within & (item.sof | starts)),
            ]
        return m
