"""Turns whatever markers arrive into frames that are whole."""

from amaranth.hdl import Module, Mux, Signal, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.signatures import COUNTER_BITS, PIXEL_BITS, PixelPair, Status
from softdepth.spec.config import Config


def item_layout(config: Config) -> data.StructLayout:
    """What leaves the guard: a pixel pair at column ``x``, or a bare ``end``.

    Every frame begins with ``sof``, all its lines are equally long, and it is ended once: by
    ``eof`` on its last pixel, or by an ``end`` item without a pixel. ``damaged`` tells that the
    frame was mended, or cut short, up to here.

    What the sequencer wants to know of ``x``: ``first``: it is the line's first pixel. ``completes``: with
    it, the line's first pixel has all that it sees to its right. ``inner``: with it, a pixel is complete
    whose support lies inside the image; ``first_inner``: it is the first of these. The last three are
    never set with ``sof``, and none is with ``end``.
    """
    return data.StructLayout(
        {
            "left": unsigned(PIXEL_BITS),
            "right": unsigned(PIXEL_BITS),
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
    """Learns width and height from the markers and mends what does not fit.

    A frame's first line gives its width. Short lines are padded with their last pixel, long ones
    are cut, pixels outside any frame are dropped, and a start of frame before the end closes the
    running frame first; each is counted in ``status`` and marks the frame as damaged. Sound frames
    pass unchanged, without a cycle lost.

    A source that never sets ``eof`` is served too: the first frame ends when the second begins, from
    then on the height is known. It changes when three frames in a row agree on another, so that starts
    of frame misplaced within one do not change it.

    Members
    -------
    i : pixel pairs with raw markers. ``ready`` depends on ``valid``.
    o : well-formed items, in the same clock.
    status : counters of what was mended.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        super().__init__(
            {
                "i": In(stream.Signature(PixelPair)),
                "o": Out(stream.Signature(item_layout(config))),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        pair, item = self.i.payload, self.o.payload
        taken = Signal()  # an item leaves
        m.d.comb += taken.eq(self.o.valid & self.o.ready)

        # Where the next pixel goes.
        in_frame = Signal()
        first_line = Signal()
        x = Signal(range(config.max_width))
        within_line = Signal()  # x is not 0
        y = Signal(range(config.max_height))
        damaged = Signal()
        padding = Signal()

        starts = Signal()
        eol = Signal()
        m.d.comb += [starts.eq(pair.sof), eol.eq(pair.eol | pair.eof)]

        # The column at which the line must end, and whether it may end earlier.
        here = Signal.like(x)
        begins_line = Signal()  # whatever x says
        on_first_line = Signal()
        m.d.comb += [
            begins_line.eq(starts & ~padding),
            here.eq(Mux(begins_line, 0, x)),
            on_first_line.eq(starts | first_line),
        ]
        # Known a pixel ahead. A line has more than one pixel, so that its first is not its last.
        at_last = Signal()
        before_last = Signal.like(x, reset_less=True)  # the column before a line's last possible one
        wide_enough = Signal()  # the line may end here
        full = Signal()
        short = Signal()
        m.d.comb += [
            full.eq(at_last & ~starts),
            short.eq(eol & Mux(on_first_line, begins_line | ~wide_enough, ~full)),
        ]

        # Height, for sources that do not mark the end of a frame.
        marks_end = Signal()
        rows = Signal(range(config.max_height + 1))  # lines since the last start, dropped ones too
        previous_rows = Signal.like(rows)
        agreed = Signal()  # the two frames before were equally high
        height = Signal.like(rows)  # 0: not known yet
        is_known, is_1, less_2 = Signal(), Signal(), Signal.like(rows)  # of the height
        row = Signal.like(y)
        m.d.comb += row.eq(Mux(starts, 0, y))
        # The row is the last possible, or the last of the learnt height: known a row ahead.
        highest = Signal()
        height_ends = Signal()
        ends_here = Signal()
        too_high = Signal()
        m.d.comb += [
            ends_here.eq(
                pair.eof | (highest & ~on_first_line) | (~marks_end & Mux(on_first_line, is_1, height_ends))
            ),
            too_high.eq(marks_end & highest & ~on_first_line & ~pair.eof),
        ]
        with m.If(self.i.valid & self.i.ready & pair.eof):
            m.d.sync += marks_end.eq(1)

        padded_left = Signal(PIXEL_BITS, reset_less=True)
        padded_right = Signal(PIXEL_BITS, reset_less=True)
        eof_after_padding = Signal(reset_less=True)
        # The line's last pixel. Pixels that are not taken are kept too, as one of the line follows before any
        # padding: these registers lie far from the others, so that little may decide.
        with m.If(self.i.valid & ~padding & ~(starts & in_frame)):
            m.d.sync += [padded_left.eq(pair.left), padded_right.eq(pair.right)]
        skipping = Signal()
        dropping = Signal()
        pending_end = Signal()  # a line was cut whose tail held the end of the frame

        # Flags of x itself, as `here` comes late.
        support = config.reach_left + config.reach_right
        m.d.comb += [
            item.left.eq(pair.left),
            item.right.eq(pair.right),
            item.x.eq(here),
            item.first.eq(begins_line | ~within_line),
            item.completes.eq(~begins_line & (x == config.reach_right)),
            item.inner.eq(~begins_line & (x >= support)),
            item.first_inner.eq(~begins_line & (x == support)),
        ]

        # Counted a clock later: the counters are not part of the longest path.
        events = {name: Signal(name=f"counts_{name}") for name in Status.members}
        for name, event in events.items():
            counter = self.status[name]
            m.d.sync += event.eq(0)
            with m.If(event & (counter != 2**COUNTER_BITS - 1)):
                m.d.sync += counter.eq(counter + 1)

        def count(name: str) -> None:
            m.d.sync += events[name].eq(1)

        # A clock later: a line is longer than that.
        line_left = Signal()
        left_at = Signal.like(x, reset_less=True)
        m.d.sync += line_left.eq(0)
        with m.If(line_left):
            m.d.sync += before_last.eq(left_at - 1)

        def advance(column: Signal) -> None:
            """A pixel leaves at a column, and the line goes on unless `finish_line` says otherwise."""
            m.d.sync += [
                x.eq(column + 1),
                within_line.eq(1),
                at_last.eq(column == before_last),
                wide_enough.eq(column >= config.min_width - 2),
                left_at.eq(column),
            ]

        def finish_line(ends: Signal) -> None:
            """The pixel that leaves is its line's last."""
            m.d.sync += [
                x.eq(0),
                within_line.eq(0),
                at_last.eq(0),
                wide_enough.eq(0),
                line_left.eq(1),
                y.eq(row + 1),
                highest.eq(row == config.max_height - 2),
                height_ends.eq(row == less_2),
                first_line.eq(0),
            ]
            with m.If(ends):
                m.d.sync += in_frame.eq(0)

        with m.If(pending_end):
            # No pixel is offered: what the source shows meanwhile must not shine through.
            m.d.comb += [self.o.valid.eq(1), item.eq(0), item.end.eq(1), item.damaged.eq(1)]
            with m.If(taken):
                m.d.sync += [pending_end.eq(0), in_frame.eq(0)]
        with m.Elif(padding):
            at_end = Signal()
            m.d.comb += [
                at_end.eq(Mux(first_line, wide_enough, at_last)),
                self.o.valid.eq(1),
                item.left.eq(padded_left),
                item.right.eq(padded_right),
                item.eol.eq(at_end),
                item.eof.eq(at_end & eof_after_padding),
                item.damaged.eq(1),
                row.eq(y),
            ]
            with m.If(taken):
                advance(x)
                with m.If(at_end):
                    m.d.sync += padding.eq(0)
                    finish_line(eof_after_padding)
        with m.Elif(skipping & ~(self.i.valid & starts)):
            m.d.comb += self.i.ready.eq(1)
            with m.If(self.i.valid & eol):
                m.d.sync += [skipping.eq(0), pending_end.eq(pair.eof & in_frame)]
        with m.Elif(self.i.valid & starts & in_frame):
            m.d.sync += skipping.eq(0)
            with m.If(within_line):
                count("early_starts")
                count("short_lines")
                m.d.sync += [padding.eq(1), damaged.eq(1), eof_after_padding.eq(1)]
            with m.Else():
                early = Signal()
                m.d.comb += [
                    early.eq(marks_end | is_known),
                    self.o.valid.eq(1),
                    item.end.eq(1),
                    item.first.eq(0),
                    item.damaged.eq(damaged | early),
                ]
                with m.If(taken):
                    m.d.sync += in_frame.eq(0)
                    with m.If(early):
                        count("early_starts")
        with m.Elif(self.i.valid & ~starts & ~in_frame):
            m.d.comb += self.i.ready.eq(1)
            m.d.sync += [dropping.eq(1), skipping.eq(0)]
            with m.If(~dropping):
                count("missing_starts")
        with m.Elif(self.i.valid):
            m.d.comb += [
                self.o.valid.eq(1),
                self.i.ready.eq(self.o.ready),
                item.sof.eq(starts),
                item.eol.eq((eol & ~short) | full),
                item.eof.eq(item.eol & ends_here),
                item.damaged.eq((damaged & ~starts) | short | (full & ~eol) | (too_high & item.eol)),
            ]
            with m.If(taken):
                advance(here)
                m.d.sync += [
                    in_frame.eq(1),
                    dropping.eq(0),
                    skipping.eq(0),
                    damaged.eq(item.damaged),
                    eof_after_padding.eq(ends_here),
                ]
                with m.If(starts):
                    m.d.sync += [first_line.eq(1), y.eq(0), at_last.eq(0)]
                    m.d.sync += before_last.eq(config.max_width - 2)
                with m.If(item.eol):
                    finish_line(item.eof)
                with m.If(short):
                    count("short_lines")
                    m.d.sync += padding.eq(1)
                with m.If(full & ~eol):
                    count("long_lines")
                    m.d.sync += skipping.eq(1)

        # A clock later, like the counters: nothing looks at the height so soon.
        began = Signal()
        line_ended = Signal()
        accepted = self.i.valid & self.i.ready
        m.d.sync += [began.eq(accepted & starts), line_ended.eq(accepted & eol)]
        counted = Signal.like(rows)
        m.d.comb += counted.eq(Mux(began, 0, rows))
        m.d.sync += [
            rows.eq(counted + (line_ended & (counted != config.max_height))),
            is_known.eq(height != 0),
            is_1.eq(height == 1),
            less_2.eq(height - 2),
        ]
        with m.If(began & (rows != 0)):
            m.d.sync += [previous_rows.eq(rows), agreed.eq(rows == previous_rows)]
            with m.If((height == 0) | (agreed & (rows == previous_rows))):
                m.d.sync += height.eq(rows)
        return m
