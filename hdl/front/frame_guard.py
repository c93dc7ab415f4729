"""Makes whole frames of whatever markers arrive."""

from amaranth.hdl import Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.columns import Columns
from softdepth.hdl.front.fault_counters import FaultCounters
from softdepth.hdl.front.height_learner import HeightLearner
from softdepth.hdl.front.silence import Silence
from softdepth.hdl.front.states import States
from softdepth.hdl.signatures import STEERING, Faults, Status, pair_layout
from softdepth.spec.config import Config


def item_layout(config: Config) -> data.StructLayout:
    """What leaves the guard: a pixel pair at column ``x``, or a bare ``end``.

    Every frame begins with ``sof``, all its lines are equally long, and it is ended once: by
    ``eof`` on its last pixel, or by an ``end`` item without a pixel. ``damaged`` says that the
    frame was mended, or cut short, up to here.

    The last four tell the sequencer about column ``x``. ``first``: it is the line's first. ``completes``:
    with it, the line's first pixel has everything that it looks at to its right. ``inner``: with it, a pixel
    is complete whose support lies inside the image; ``first_inner``: it is the first of these. The
    last three are never set together with ``sof``, and none of the four with ``end``.
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
    """Makes whole frames of whatever markers arrive; sound frames pass, and none of their pixels waits.

    A frame's first line gives its width. Short lines are filled up, long ones are cut, pixels outside any
    frame are dropped, and a start of frame before the end closes the running frame first. Each fault is
    counted in ``status``, and marks the frame as damaged from there on. The table of faults is in
    docs/gateware.md; `HeightLearner` and `Silence` say how a frame's end is known without end marks.

    States
    ------
    OUTSIDE : no frame is open. IGNORE : the same, in a frame that is skipped.
    DROP : no frame is open, and pixels have come that belong to none.
    BETWEEN : a frame is open, and a line of it is complete. LINE : a line has begun.
    LAST : a frame is open, and it has all the lines that it can have.
    PAD : a short line is filled with its last pixel.
    SKIP : the rest of a line that was cut is dropped.
    END : a frame ended in the part that was cut, and the sequencer has not been told yet.
    OVER : the same for a frame that a silence has ended.

    Members
    -------
    i : pixel pairs with raw markers. ``ready`` depends on ``valid``.
    o : well-formed items, in the same clock.
    hold : no frame begins; its first pixel waits, but still ends the frame before it.
    skip : a frame that begins is dropped as a whole and not counted.
    clear : sets the counters to 0.
    forget : as in `HeightLearner`.
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
        m.submodules.silence = silence = Silence(config)
        m.submodules.columns = columns = Columns(config)
        m.submodules.counters = counters = FaultCounters()
        m.d.comb += [
            self.status.eq(counters.status),
            self.faults.eq(counters.met),
            counters.clear.eq(self.clear),
            learner.forget.eq(self.forget),
        ]

        states = States(
            m, "OUTSIDE", "IGNORE", "DROP", "BETWEEN", "LINE", "LAST", "PAD", "SKIP", "END", "OVER"
        )
        at = states.at
        closed = states.group("OUTSIDE", "IGNORE", "DROP")  # no frame is open
        goes_on = states.group("BETWEEN", "LINE")  # the next pixel belongs to the frame
        unwanted = states.group("OUTSIDE", "IGNORE", "DROP", "SKIP")  # it is dropped
        ended_by_start = states.group("BETWEEN", "LAST", "SKIP")  # a pixel that starts a frame ends this one
        ending = states.group("END", "OVER")
        own = states.group("PAD", "END", "OVER")  # what leaves is not the pixel on offer

        starts = Signal()  # a pixel that starts a frame is offered
        rest = Signal()  # any other is
        eol = Signal()
        begins = Signal()  # a frame may begin
        m.d.comb += [
            starts.eq(self.i.valid & pair.sof),
            rest.eq(self.i.valid & ~pair.sof),
            eol.eq(pair.eol | pair.eof),
            begins.eq(starts & closed & ~self.skip & ~self.hold),
        ]

        # What is done in this clock: at most one of these.
        passes = Signal()  # the pixel that is offered leaves
        drops = Signal()  # it is dropped
        fills = at["PAD"]  # the line's last pixel leaves once more
        ends = Signal()  # a bare end leaves
        may_leave = self.o.ready
        m.d.comb += [
            passes.eq((rest & goes_on) | begins),
            drops.eq((rest & unwanted) | (starts & closed & self.skip)),
            ends.eq((starts & ended_by_start) | (rest & at["LAST"]) | ending),
            self.o.valid.eq(passes | fills | ends),
            self.i.ready.eq((passes & may_leave) | drops),
            counters.again.eq(self.o.valid & ~may_leave),
        ]

        # What a pixel that passes does: it ends its line, or is the last before the line is filled or cut.
        short = Signal()
        cut = Signal()
        line_ends = Signal()
        end_waits = Signal(reset_less=True)  # the line that is being filled had its frame's end
        m.d.comb += [
            short.eq(passes & eol & ~columns.may_end),
            cut.eq(passes & ~eol & columns.must_end),
            line_ends.eq(columns.may_end & (fills | eol | columns.must_end)),
            columns.steps.eq((passes | fills) & may_leave),
            columns.starts.eq(begins),
            columns.line_ends.eq(line_ends),
        ]

        def follow(line: Value, frame: Value) -> None:
            """The state after a `line` that ends here, with its `frame` or without."""
            with m.If(line & frame):
                states.go("OUTSIDE")
            with m.If(line & ~frame & learner.is_last):
                states.go("LAST")
            with m.If(line & ~frame & ~learner.is_last):
                states.go("BETWEEN")

        with m.If(passes & may_leave):
            follow(eol & columns.may_end, pair.eof)
            with m.If(eol & ~columns.may_end):
                states.go("PAD")
            with m.If(~eol & columns.must_end):
                states.go("SKIP")
            with m.If(~eol & ~columns.must_end):
                states.go("LINE")
        with m.If(starts & closed & self.skip):
            states.go("IGNORE")
        with states.state("OUTSIDE"), m.If(rest):
            m.d.comb += counters.missing_starts.eq(1)
            states.go("DROP")
        with states.state("LINE"), m.If(starts):
            states.go("PAD")
        with states.state("PAD"), m.If(may_leave):
            follow(columns.may_end, end_waits)
        with states.state("SKIP"), m.If(rest & eol):
            with m.If(pair.eof):
                states.go("END")
            with m.Elif(learner.is_last):
                states.go("LAST")
            with m.Else():
                states.go("BETWEEN")
        with m.If(ends & may_leave):
            states.go("OUTSIDE")
        m.d.comb += silence.waits.eq((at["BETWEEN"] | at["LAST"]) & learner.may_end)
        with m.If((at["BETWEEN"] | at["LAST"]) & silence.over & ~self.i.valid):
            states.go("OVER")

        # If nothing else tells that a frame has ended, the next start after a whole line does.
        early = Signal()
        found = Signal()  # a fault in what leaves, besides the length of its line
        m.d.comb += [
            early.eq(starts & (at["BETWEEN"] | at["LAST"]) & learner.is_early),
            found.eq(fills | at["END"] | (rest & at["LAST"]) | early),
            counters.early_starts.eq(early | (starts & (at["LINE"] | at["SKIP"]))),
            counters.short_lines.eq(short | (starts & at["LINE"])),
            counters.long_lines.eq(cut),
        ]

        # Damage is known one clock after it left, and forgotten one clock after its frame's end left.
        hurt = Signal()
        damaged = Signal()
        so_far = Signal()  # this frame was damaged before
        m.d.comb += so_far.eq((damaged | hurt) & ~closed)
        m.d.sync += [hurt.eq(self.o.valid & may_leave & (found | short | cut)), damaged.eq(so_far)]

        # A line's last pixel, to fill the line with. These registers are far from the others, so as little as
        # possible decides when they load: they take any pixel on offer, and a pixel of the line always comes
        # before the line is filled. What the source offers while it is filled does not matter.
        kept = {
            side: Signal(config.pixel.size, name=f"kept_{side}", reset_less=True)
            for side in ("left", "right")
        }
        with m.If(self.i.valid & ~own & ~(at["LINE"] & pair.sof)):
            m.d.sync += [kept[side].eq(pair[side]) for side in kept]
        with m.If(~fills):
            m.d.sync += end_waits.eq(pair.eof | (at["LINE"] & pair.sof))

        # If nothing reaches to the right, a line's first pixel completes itself, except the frame's first.
        first = passes & ~at["LINE"]
        m.d.comb += [
            item.left.eq(Mux(own, kept["left"], pair.left)),
            item.right.eq(Mux(own, kept["right"], pair.right)),
            item.x.eq(columns.x),
            item.sof.eq(begins),
            item.eol.eq(line_ends),
            item.eof.eq(line_ends & Mux(fills, end_waits, pair.eof)),
            item.end.eq(ends),
            item.damaged.eq(so_far | found | short | cut),
            item.first.eq(first),
            item.completes.eq(columns.completes if config.reach_right else first & ~pair.sof),
            item.first_inner.eq(columns.first_inner),
            item.inner.eq(columns.inner),
            learner.frame.eq(begins & may_leave),
            learner.line.eq(first & may_leave),
            learner.whole.eq(ends & may_leave & (starts | at["OVER"]) & ~so_far),
            learner.dropped.eq((at["OUTSIDE"] | at["DROP"]) & rest & eol),
            learner.mark.eq(self.i.valid & self.i.ready & pair.eof),
        ]
        return m
