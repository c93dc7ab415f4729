"""Learns how a source's frames end, and tells which line is a frame's last."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import Config

REPORT_CLOCKS = 3
"""Clocks from a line's first pixel to what is said of the line: no line has fewer than `NARROWEST` pixels."""


class HeightLearner(wiring.Component):
    """Counts a frame's lines and knows where the frame ends, whether or not the source marks it.

    It begins ``UNKNOWN``, and nothing but frames that are whole can change that. Two of them in a row that
    are equally high and bear no end mark make the source one that is supposed to have a ``HEIGHT``: a
    silence after its last line ends a frame. Where the next line follows, the frame is taller, and nothing
    is known any more. A third frame confirms the height: from then on lines that follow are a fault. An end
    mark, wherever it stands, makes the source one that ``MARKS`` its ends, until reset, or `forget`.

    A height changes when three whole frames in a row agree on a lower one. A confirmed one is forgotten when
    lines follow its last, which a taller frame has and which are lost. Whole multiples of the height are
    forgiven once: starts of frame that went missing look the same.

    Members
    -------
    frame : a frame's first pixel is taken in this clock.
    line : a line's first pixel is taken, of a frame's first line too.
    whole : a frame without fault has ended by silence, or by the next frame's start, which is taken later.
    dropped : a line has ended that belongs to no frame.
    mark : an end mark is taken, wherever it stands.
    forget : no frame is open, and what was learnt is void: as after reset.
    is_last : no line can follow the running one, by a confirmed height or ``max_height``.
    may_end : silence after the running line ends the frame.
    is_early : the next frame's start after the running line would come too early.

    What is said of a line is true `REPORT_CLOCKS` after it began.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        inputs = ("frame", "line", "whole", "dropped", "mark", "forget")
        outputs = ("is_last", "may_end", "is_early")
        super().__init__({**{name: In(1) for name in inputs}, **{name: Out(1) for name in outputs}})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # What is reported comes from far away: it is looked at a clock later.
        frame, line, whole, dropped, mark = (
            Signal(name=f"{name}_was") for name in ("frame", "line", "whole", "dropped", "mark")
        )
        m.d.sync += [
            frame.eq(self.frame),
            line.eq(self.line),
            whole.eq(self.whole),
            dropped.eq(self.dropped),
            mark.eq(self.mark),
        ]

        row = Signal(range(self._config.max_height))  # of the newest line
        last = Signal.like(row)  # the last row, where the height is known
        at_last = Signal()
        m.d.comb += at_last.eq(row == last)
        with m.If(line):
            m.d.sync += row.eq(Mux(frame, 0, row + 1))

        seen = Signal.like(row)  # the last row of the newest whole frame
        streak = Signal(range(3))  # whole frames in a row that had it; more than two are two
        is_same = Signal()  # known a clock later: a line that has ended began long ago
        agrees = Signal()
        m.d.sync += is_same.eq(row == seen)
        m.d.comb += agrees.eq((streak != 0) & is_same)
        was_whole = Signal()
        overran = Signal()  # lines followed this frame's last
        with m.If(whole):
            m.d.sync += [seen.eq(row), streak.eq(Mux(agrees, 2, 1)), was_whole.eq(1)]
        with m.If(frame):
            m.d.sync += was_whole.eq(0)
            with m.If(~was_whole | overran):
                m.d.sync += streak.eq(0)

        overran_before = Signal()
        confirmed = Signal()  # by a third frame: lines that follow are a fault
        with m.If(self.forget):
            m.d.sync += [streak.eq(0), was_whole.eq(0), overran.eq(0), overran_before.eq(0)]
        with m.FSM(name="ends") as ends:
            with m.State("UNKNOWN"):
                with m.If(whole & agrees):
                    m.d.sync += [last.eq(row), confirmed.eq(0)]
                    m.next = "HEIGHT"
                with m.If(mark):
                    m.next = "MARKS"
            with m.State("HEIGHT"):
                with m.If(dropped):
                    # Counted modulo the height, so that the rows of whole frames end at the last.
                    m.d.sync += [row.eq(Mux(at_last, 0, row + 1)), overran.eq(1)]
                with m.If(whole & agrees & (streak == 2)):
                    m.d.sync += [last.eq(row), confirmed.eq(1)]
                with m.If(line & ~frame & at_last):
                    m.next = "UNKNOWN"
                with m.If(frame):
                    m.d.sync += [overran.eq(0), overran_before.eq(overran)]
                    with m.If(overran & (overran_before | ~at_last)):
                        m.d.sync += overran_before.eq(0)
                        m.next = "UNKNOWN"
                with m.If(mark):
                    m.next = "MARKS"
                with m.If(self.forget):
                    m.next = "UNKNOWN"
            with m.State("MARKS"), m.If(self.forget):
                m.next = "UNKNOWN"
        knows_height, marks = ends.ongoing("HEIGHT"), ends.ongoing("MARKS")
        is_lowest = row == self._config.max_height - 1
        m.d.sync += [
            self.is_last.eq((knows_height & at_last & confirmed) | is_lowest),
            self.may_end.eq((knows_height & at_last) | (~marks & is_lowest)),
            self.is_early.eq(marks | (knows_height & ~at_last)),
        ]
        return m
