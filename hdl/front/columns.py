"""Counts the columns of a frame's lines, and learns how wide they are."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import Config


class Columns(wiring.Component):
    """Tells the guard what it needs to know about the next pixel's column; all but ``x`` a pixel ahead, in
    registers.

    A frame's first line gives the width.

    Members
    -------
    steps : a pixel leaves, at column ``x``.
    starts : it is a frame's first.
    line_ends : it is a line's last.
    x : the column of the next pixel.
    may_end : a line is wide enough to end with it.
    must_end : it cannot be any wider.
    completes, inner, first_inner : of the next pixel, as in the guard's items.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        outputs = ("may_end", "must_end", "completes", "inner", "first_inner")
        super().__init__(
            {
                **{name: In(1) for name in ("steps", "starts", "line_ends")},
                "x": Out(range(config.max_width)),
                **{name: Out(1) for name in outputs},
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config, x = self._config, self.x
        support = config.reach_left + config.reach_right
        first_line = Signal()  # the frame's first line has begun, and no other
        previous = Signal.like(x, reset_less=True)  # the column before the next
        second_last = Signal.like(x, init=config.max_width - 2)  # of the frame's lines
        is_second_last = Signal()
        m.d.comb += is_second_last.eq(x == second_last)
        with m.If(self.steps):
            m.d.sync += [
                x.eq(x + 1),
                previous.eq(x),
                self.completes.eq(x == config.reach_right - 1),
                self.first_inner.eq(x == support - 1),
            ]
            with m.If(x == support - 1):
                m.d.sync += self.inner.eq(1)
            with m.If(first_line):
                m.d.sync += [
                    second_last.eq(previous),
                    self.must_end.eq(x == config.max_width - 2),
                ]
                with m.If(x == config.min_width - 2):
                    m.d.sync += self.may_end.eq(1)
            with m.Else():
                m.d.sync += [self.may_end.eq(is_second_last), self.must_end.eq(is_second_last)]
            with m.If(self.starts):
                m.d.sync += first_line.eq(1)
            with m.If(self.line_ends):
                m.d.sync += [
                    each.eq(0)
                    for each in (
                        x,
                        self.may_end,
                        self.must_end,
                        first_line,
                        self.completes,
                        self.inner,
                        self.first_inner,
                    )
                ]
        return m
