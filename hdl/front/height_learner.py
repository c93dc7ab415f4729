"""Learns how a source ends its frames, and says which line is a frame's last."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import Config

REPORT_CLOCKS = 3
"""Clocks from a line's first pixel to the outputs about it; every line has at least `NARROWEST` pixels."""


class HeightLearner(wiring.Component):
    """Counts a frame's lines and knows where the frame ends, whether or not the source marks it.

    It begins in ``UNKNOWN``, and only whole frames can change that. After two of them in a row with the same
    height and without an end mark, it assumes that the source has this ``HEIGHT``, and a silence after the
    last line ends a frame. If another line follows instead, the frame is taller, and nothing is known any
    more. A third frame confirms the height: from then on, further lines are a fault. An end mark, wherever
    it stands, shows that the source ``MARKS`` its ends, until reset or `forget`.

    A height changes when three whole frames in a row agree on a lower one. A confirmed height is forgotten
    when further lines follow, which a taller frame has and which are lost. If their number is a multiple of
    the height, it is kept once, because missing starts of frame look the same.

    Members
    -------
    frame : a frame's first pixel is taken in this clock.
    line : a line's first pixel is taken, also that of a frame's first line.
    whole : a sound frame was ended by a silence, or by the next frame's start, which is taken later.
    dropped : a line that belongs to no frame has ended.
    mark : an end mark is taken, wherever it stands.
    forget : no frame is open, and everything learnt is dropped, as after reset.
    is_last : no line can follow the running one, because of a confirmed height or ``max_height``.
    may_end : a silence after the running line ends the frame.
    is_early : if the next frame started after the running line, that would be too early.

    The outputs about a line are valid `REPORT_CLOCKS` after it began.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        inputs = ("frame", "line", "whole", "dropped", "mark", "forget")
        outputs = ("is_last", "may_end", "is_early")
        super().__init__({**{name: In(1) for name in inputs}, **{name: Out(1) for name in outputs}})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # The inputs come from far away, so they are used one clock later.
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
        is_same = Signal()  # known one clock later, which is early enough: the line began long ago
        agrees = Signal()
        m.d.sync += is_same.eq(row == seen)
        m.d.comb += agrees.eq((streak != 0) & is_same)
        was_whole = Signal()
        overran = Signal()  # further lines followed this frame's last
        with m.If(whole):
            m.d.sync += [seen.eq(row), streak.eq(Mux(agrees, 2, 1)), was_whole.eq(1)]
        with m.If(frame):
            m.d.sync += was_whole.eq(0)
            with m.If(~was_whole | overran):
                m.d.sync += streak.eq(0)

        overran_before = Signal()
        confirmed = Signal()  # by a third frame: further lines are a fault
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
