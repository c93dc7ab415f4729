"""Which candidates' windows leave the other image."""

from amaranth.hdl import Cat, Const, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import Config


class Exclusion(wiring.Component):
    """Tells each lane whether its candidate is excluded, for every step of a pixel.

    The first inner pixel of a line has room for candidate 0 alone, and each pixel after it for one
    more. Lanes hold segments of candidates: those above the segment in which the room ends are out
    as a whole, which is a row of bits that shifts when the room crosses a segment; in that segment
    the step decides. So a lane costs two flip-flops and a table of three inputs.

    Members
    -------
    valid : a step is taken.
    first : it is its pixel's first; never without ``valid``.
    starts : the pixel is its line's first inner one.
    lanes : a bit a lane, `latency` clocks after the step. Before a line's first inner pixel they say
        nothing.
    """

    latency = 2

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "valid": In(1),
                "first": In(1),
                "starts": In(1),
                "lanes": Out(config.lanes),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        lanes, steps = self._config.lanes, self._config.steps
        outside = Signal(lanes, reset_less=True)  # bit k: the room ends below lane k's segment
        room = Signal(range(steps), reset_less=True)  # within the segment in which it ends
        left = Signal(range(steps), reset_less=True)  # steps until that segment's candidate has room
        now = Signal.like(room)
        m.d.comb += now.eq(room)
        with m.If(self.first):
            with m.If(self.starts):
                m.d.comb += now.eq(0)
                m.d.sync += outside.eq(-2)
            with m.Elif(room != steps - 1):
                m.d.comb += now.eq(room + 1)
            with m.Elif(outside[-1]):
                m.d.comb += now.eq(0)
                m.d.sync += outside.eq(Cat(Const(0, 1), outside))
            m.d.sync += [room.eq(now), left.eq(steps - 1 - now)]
        with m.Elif(self.valid & (left != 0)):
            m.d.sync += left.eq(left - 1)

        excluded = Signal(lanes, reset_less=True)
        ends_here = ~outside & Cat(outside[1:], Const(1, 1))
        m.d.sync += excluded.eq(outside | (ends_here & (left != 0).replicate(lanes)))
        m.d.comb += self.lanes.eq(excluded)
        return m
