"""Turns whatever markers arrive into frames that are whole."""

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.fault_counters import FaultCounters
from softdepth.hdl.front.height_learner import HeightLearner
from softdepth.hdl.signatures import STEERING, Faults, Status, pair_layout
from softdepth.spec.config import Config


def item_layout(config: Config) -> data.StructLayout:
    """What leaves the guard: a pixel pair at column ``x``, or a bare ``end``.

    Every frame begins with ``sof``, all its lines are equally long, and it is ended once: by
    ``eof`` on its last pixel, or by an ``end`` item without a pixel. ``damaged`` tells that the
    frame was mended, or cut short, up to here.

    The last four are for the sequencer and speak of ``x``. ``first``: it is the line's first column.
    ``completes``: with it, the line's first pixel has all that it sees to its right. ``inner``: with it, a
    pixel is complete whose support lies inside the image; ``first_inner``: it is the first of these. The
    last three are never set with ``sof``, and none is with ``end``.
    """
    return data.StructLayout(
        {
            "left": unsigned(config.pixel.size),
            "right": unsigned(config.pixel.size),
            "x": range(config.max_width),
            "sof": 1,
            "eol": 1,
            "eof": 1,
            "end": 1,
            "damaged": 1,
            "first": 1,
            "completes": 1,
            "inner": 1,
            "first_inner": 1,
        }
    )


class FrameGuard(wiring.Component):
    """Turns whatever markers arrive into whole frames; sound frames pass without a cycle lost.

    A frame's first line gives its width. Short lines are filled up, long ones are cut, pixels outside any
    frame are dropped, and a start of frame before the end closes the running frame first. Each fault is
    counted in ``status``, and marks the frame as damaged from there on. The table of faults is in
    docs/gateware.md; how the end of a frame is known without end marks, in `HeightLearner`.

    States
    ------
    OUTSIDE : no frame is open. IGNORE : the same, in a frame that is skipped.
    DROP : no frame is open, and pixels that belong to none have come.
    BETWEEN : a frame is open, and a line of it is complete. LINE : the line has begun.
    PAD : a short line is filled with its last pixel.
    SKIP : the rest of a line that was cut is dropped. SKIP_LAST : the same, of a frame's last line.
    END : a frame ended in what was cut, and has yet to be ended for the sequencer.

    Members
    -------
    i : pixel pairs with raw markers. ``ready`` depends on ``valid``.
    o : well-formed items, in the same clock.
    hold : no frame begins: its first pixel waits, and ends the frame before as it does otherwise.
    skip : a frame that begins is dropped whole, and nobody counts it.
    clear : the counters begin at 0.
    forget : as of `HeightLearner`.
    faults : what was met in the clock before.
    status : counters of what was mended.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "i": In(stream.Signature(pair_layout(config.pixel))),
                "o": Out(stream.Signature(item_layout(config))),
                **{name: In(1) for name in STEERING},
                "faults": Out(Faults),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        pair, item = self.i.payload, self.o.payload
        m.submodules.learner = learner = HeightLearner(config)
        m.submodules.counters = counters = FaultCounters()
        m.d.comb += [
            self.status.eq(counters.status),
            self.faults.eq(counters.met),
            counters.clear.eq(self.clear),
            learner.forget.eq(self.forget),
        ]

        starts = Signal()
        offers_start, offers_rest = (
            Signal(),
            Signal(),
        )  # a pixel is offered, and it starts a frame, or does not
        eol = Signal()
        m.d.comb += [
            starts.eq(pair.sof),
            offers_start.eq(self.i.valid & starts),
            offers_rest.eq(self.i.valid & ~starts),
            eol.eq(pair.eol | pair.eof),
        ]

        # What a state decides. At most one of them is set.
        passes = Signal()  # the pixel that is offered leaves
        drops = Signal()  # it is dropped
        fills = Signal()  # the line's last pixel leaves once more
        ends = Signal()  # a bare end leaves
        taken = Signal()  # an item leaves
        m.d.comb += [
            self.o.valid.eq(passes | fills | ends),
            self.i.ready.eq((passes & self.o.ready) | drops),
            taken.eq(self.o.valid & self.o.ready),
            counters.again.eq(self.o.valid & ~self.o.ready),
        ]

        # The column of the next pixel. The rest is known a pixel ahead: a line has more than one.
        x = Signal(range(config.max_width))
        may_end = Signal()  # the line is wide enough to end there
        must_end = Signal()  # and cannot be any wider
        first_line = Signal()  # the frame's first line has begun, and no other
        previous = Signal.like(x, reset_less=True)  # the column before it
        second_last = Signal.like(x, init=config.max_width - 2)  # of the frame's lines
        support = config.reach_left + config.reach_right
        completes, inner, first_inner = Signal(), Signal(), Signal()

        short, cut, line_ends, frame_ends = Signal(), Signal(), Signal(), Signal()
        end_waits = Signal(reset_less=True)  # the line that is filled bore its frame's end
        m.d.comb += [
            short.eq(passes & eol & ~may_end),
            cut.eq(passes & must_end & ~eol),
            line_ends.eq(may_end & (fills | must_end | eol)),
            frame_ends.eq(Mux(fills, end_waits, pair.eof) | learner.is_last),
        ]
        with m.If(taken & ~ends):
            m.d.sync += [
                x.eq(x + 1),
                previous.eq(x),
                completes.eq(x == config.reach_right - 1),
                first_inner.eq(x == support - 1),
            ]
            with m.If(x == support - 1):
                m.d.sync += inner.eq(1)
            with m.If(first_line):
                m.d.sync += [
                    second_last.eq(previous),
                    must_end.eq(x == config.max_width - 2),
                ]
                with m.If(x == config.min_width - 2):
                    m.d.sync += may_end.eq(1)
            with m.Else():
                is_second_last = x == second_last
                m.d.sync += [may_end.eq(is_second_last), must_end.eq(is_second_last)]
            with m.If(passes & starts):
                m.d.sync += first_line.eq(1)
            with m.If(line_ends):
                m.d.sync += [
                    each.eq(0) for each in (x, may_end, must_end, first_line, completes, inner, first_inner)
                ]

        damaged = Signal()  # this frame, by what came before
        found = Signal()  # another fault, in this clock
        closes = Signal()  # the frame ends with what leaves
        m.d.comb += closes.eq(ends | (line_ends & frame_ends))
        with m.If(taken):
            m.d.sync += damaged.eq(item.damaged & ~closes)

        with m.FSM(name="frame") as frame:

            def pass_on() -> None:
                """The pixel leaves, and the next belongs to the same line or lies behind it."""
                m.d.comb += passes.eq(1)
                m.d.comb += [counters.short_lines.eq(short), counters.long_lines.eq(cut)]
                with m.If(taken):
                    with m.If(short):
                        m.next = "PAD"
                    with m.Elif(~line_ends):
                        m.next = "LINE"
                    with m.Elif(frame_ends):
                        m.next = "OUTSIDE"
                        with m.If(cut):
                            m.next = "SKIP_LAST"
                    with m.Else():
                        m.next = "BETWEEN"
                        with m.If(cut):
                            m.next = "SKIP"

            def begin() -> None:
                """A frame begins, unless it has to wait or is skipped."""
                with m.If(offers_start & self.skip):
                    m.d.comb += drops.eq(1)
                    m.next = "IGNORE"
                with m.Elif(offers_start & ~self.hold):
                    pass_on()

            with m.State("OUTSIDE"):
                begin()
                with m.If(offers_rest):
                    m.d.comb += [drops.eq(1), counters.missing_starts.eq(1)]
                    m.next = "DROP"
            with m.State("IGNORE"):
                begin()
                with m.If(offers_rest):
                    m.d.comb += drops.eq(1)
            with m.State("DROP"):
                begin()
                with m.If(offers_rest):
                    m.d.comb += drops.eq(1)
            with m.State("SKIP_LAST"):
                begin()
                with m.If(offers_rest):
                    m.d.comb += drops.eq(1)
                    with m.If(eol):
                        m.next = "OUTSIDE"
            with m.State("BETWEEN"):
                with m.If(offers_start):
                    # Without another way to know it, this is how frames end.
                    m.d.comb += [ends.eq(1), found.eq(learner.knows_end)]
                with m.If(offers_rest & learner.is_lowest):
                    m.d.comb += [ends.eq(1), found.eq(1)]
                with m.If(offers_rest & ~learner.is_lowest):
                    pass_on()
                m.d.comb += counters.early_starts.eq(offers_start & learner.knows_end)
                with m.If(ends & taken):
                    m.d.comb += learner.whole.eq(starts & ~damaged)
                    m.next = "OUTSIDE"
            with m.State("LINE"):
                with m.If(offers_start):
                    m.d.comb += [counters.early_starts.eq(1), counters.short_lines.eq(1)]
                    m.next = "PAD"
                with m.If(offers_rest):
                    pass_on()
            with m.State("PAD"):
                m.d.comb += [fills.eq(1), found.eq(1)]
                with m.If(taken & line_ends):
                    m.next = "BETWEEN"
                    with m.If(frame_ends):
                        m.next = "OUTSIDE"
            with m.State("SKIP"):
                with m.If(offers_start):
                    m.d.comb += [ends.eq(1), counters.early_starts.eq(1)]
                    with m.If(taken):
                        m.next = "OUTSIDE"
                with m.If(offers_rest):
                    m.d.comb += drops.eq(1)
                    with m.If(eol):
                        m.next = "BETWEEN"
                        with m.If(pair.eof):
                            m.next = "END"
            with m.State("END"):
                m.d.comb += [ends.eq(1), found.eq(1)]
                with m.If(taken):
                    m.next = "OUTSIDE"

        # A line's last pixel, to fill it with. Whatever is offered is kept, as one of the line follows before
        # it is filled: these registers lie far from the others, so that little may decide. The source may
        # offer nothing meanwhile, or what it likes: the item does not show it.
        own = Signal()
        m.d.comb += own.eq(frame.ongoing("PAD") | frame.ongoing("END"))
        kept = {
            side: Signal(config.pixel.size, name=f"kept_{side}", reset_less=True)
            for side in ("left", "right")
        }
        within_line = frame.ongoing("LINE")
        with m.If(self.i.valid & ~own & ~(within_line & starts)):
            m.d.sync += [kept[side].eq(pair[side]) for side in kept]
        with m.If(~frame.ongoing("PAD")):
            m.d.sync += end_waits.eq(pair.eof | (within_line & starts))

        # Where nothing reaches to the right, a line's first pixel completes itself, but not the frame's.
        at_once = passes & ~starts & ~within_line
        m.d.comb += [
            item.left.eq(Mux(own, kept["left"], pair.left)),
            item.right.eq(Mux(own, kept["right"], pair.right)),
            item.x.eq(x),
            item.sof.eq(passes & starts),
            item.eol.eq(line_ends),
            item.eof.eq(line_ends & frame_ends),
            item.end.eq(ends),
            item.damaged.eq(damaged | found | short | cut),
            item.first.eq(passes & ~within_line),
            item.completes.eq(completes if config.reach_right else at_once),
            item.first_inner.eq(first_inner),
            item.inner.eq(inner),
            learner.frame.eq(taken & passes & starts),
            learner.line.eq(taken & passes & ~within_line),
            learner.dropped.eq((frame.ongoing("OUTSIDE") | frame.ongoing("DROP")) & offers_rest & eol),
            learner.mark.eq(self.i.valid & self.i.ready & pair.eof),
        ]
        return m
