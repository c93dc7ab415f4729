"""Joins the streams of two views into one of pixel pairs."""

from amaranth.hdl import Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.view_queue import view_layout
from softdepth.hdl.signatures import COUNTER_BITS


def joined_layout(bits: int) -> data.StructLayout:
    """A pixel of ``bits`` from each view, and the marks that both share."""
    return data.StructLayout({"left": unsigned(bits), "right": unsigned(bits), "sof": 1, "last": 1})


class PairSync(wiring.Component):
    """Passes pixels in pairs while both views' marks agree, and realigns the views where they do not.

    A pixel waits for the other view's, however long that takes. Where the marks of a pair differ, alignment
    is lost: each view drops pixels up to the start of a frame, and the two starts form a pair. The frame
    under way never leaves whole: no end of line leaves with marks that differ, and if both its lines had
    ended, a pixel without an end follows. So the next start is found in mid-line.

    A missing start, or one too many, would leave the views a frame apart for ever. So once per loss, a view
    gives up its start when the other view has dropped half a frame more pixels than it has itself: half of
    the latest whole frame, or ``skew`` pixels if there has been none. What leaves does not depend on when
    pixels arrive. A pair leaves in the clock in which both pixels are there; one pair a clock.

    States
    ------
    ALIGNED : pairs leave. HUNT : alignment is lost.

    Parameters
    ----------
    bits : of a pixel.
    skew : pixels that one view may be ahead.
    most_pixels : of a frame.

    Members
    -------
    left, right : streams of `view_layout`.
    o : stream of `joined_layout`.
    by_count : lines end by their length: ``last`` is ignored.
    between : the next pair begins a line.
    clear : sets ``losses`` to 0.
    lost : alignment was lost in the clock before.
    losses : how often, since reset or ``clear``; stays at its largest value.
    """

    def __init__(self, bits: int, *, skew: int, most_pixels: int) -> None:
        self._skew = skew
        self._count = range(2 * max(most_pixels, skew) + 1)
        view = stream.Signature(view_layout(bits))
        super().__init__(
            {
                "left": In(view),
                "right": In(view),
                "o": Out(stream.Signature(joined_layout(bits))),
                **{name: In(1) for name in ("by_count", "between", "clear")},
                "lost": Out(1),
                "losses": Out(COUNTER_BITS),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        views = left, right = self.left, self.right
        o, taken = self.o.payload, Signal()
        both = Signal()
        starts = Signal()
        m.d.comb += [
            both.eq(left.valid & right.valid),
            starts.eq(left.payload.sof & right.payload.sof),
            o.left.eq(left.payload.pixel),
            o.right.eq(right.payload.pixel),
            taken.eq(self.o.valid & self.o.ready),
        ]
        at_start = [view.valid & view.payload.sof for view in views]
        within = [view.valid & ~view.payload.sof for view in views]

        lost = Signal()  # in this clock
        most = self._count.stop - 1
        ahead = Signal(range(-most, most + 1))  # pixels that the left view has dropped more than the right
        limit = Signal(self._count, init=self._skew)
        given_up = Signal()
        with m.FSM(name="views"):
            with m.State("ALIGNED"):
                with m.If(both & (left.payload.sof == right.payload.sof)):
                    agree = (left.payload.last == right.payload.last) | self.by_count
                    m.d.comb += [
                        self.o.valid.eq(1),
                        o.sof.eq(starts),
                        o.last.eq(left.payload.last & right.payload.last),
                        *(view.ready.eq(self.o.ready) for view in views),
                        lost.eq(taken & ~agree),
                    ]
                with m.Elif(both & self.between):
                    m.d.comb += [
                        self.o.valid.eq(1),
                        *(
                            view.ready.eq(self.o.ready & inside)
                            for view, inside in zip(views, within, strict=True)
                        ),
                        lost.eq(taken),
                    ]
                with m.Elif(both):
                    m.d.comb += lost.eq(1)
                with m.If(lost):
                    m.d.sync += [ahead.eq(0), given_up.eq(0)]
                    m.next = "HUNT"
            with m.State("HUNT"):
                with m.If(both & starts):
                    m.next = "ALIGNED"
                with m.Else():
                    m.d.comb += [view.ready.eq(inside) for view, inside in zip(views, within, strict=True)]
                    m.d.sync += ahead.eq(_held(ahead + within[0] - within[1], most))
                    for k, far in enumerate((ahead <= -limit, ahead >= limit)):
                        with m.If(at_start[k] & within[1 - k] & far & ~given_up):
                            m.d.comb += views[k].ready.eq(1)
                            m.d.sync += given_up.eq(1)

        count = Signal(self._count)  # pairs of the frame so far
        whole = Signal()
        with m.If(taken):
            m.d.sync += count.eq(Mux(count == most, most, count + 1))
            with m.If(o.sof):
                m.d.sync += [count.eq(1), whole.eq(1)]
                with m.If(whole):
                    m.d.sync += limit.eq(count >> 1)
        was_lost = Signal()
        m.d.sync += was_lost.eq(lost)
        with m.If(lost):
            m.d.sync += whole.eq(0)
        m.d.comb += self.lost.eq(was_lost)
        with m.If(was_lost & ~self.losses.all()):
            m.d.sync += self.losses.eq(self.losses + 1)
        with m.If(self.clear):
            m.d.sync += self.losses.eq(0)
        return m


def _held(value: Value, most: int) -> Value:
    """`value` within ``-most .. most``."""
    return Mux(value > most, most, Mux(value < -most, -most, value))
