"""Windows of a raster that reach far up: all rows that a pixel's column sums take in and leave out."""

from amaranth.hdl import Cat, Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.folded_memory import FoldedMemory
from softdepth.hdl.memory.window import MARKERS, raster_layout
from softdepth.hdl.memory.window_slots import WindowSlots


class TallWindow(wiring.Component):
    """Gives each pixel the rows from ``reach`` below it to as many above it as are wanted.

    A frame's edges are repeated, as far as a window of ``reach`` needs them whose centre lies in the frame:
    a line's first and last columns enter ``reach`` times more than once, a frame's first row into the
    ``reach`` rows above it, and below its last row a column's newest pixel enters again. Behind a frame's
    lines there come ``after`` more, of which the rows above alone mean anything. So a line takes ``2 reach``
    slots more than it has pixels, and a frame ``reach + after`` lines more, in which the input is held back;
    nothing waits for the frame that follows.

    Parameters
    ----------
    element : what is wanted of all rows.
    companion : what is wanted of one pixel alone: of that ``after`` rows above the centre.
    reach : rows below the centre, and columns to its sides.
    depth : rows from the newest to the oldest, that one not counted.
    max_width : pixels of the longest line; the shortest has 4.
    clocks : of a slot, at least; with more than one, memory is smaller (`FoldedMemory`).

    Members
    -------
    i : a raster.
    credit : a window may be begun in this clock.
    promised : one is: it leaves `latency` clocks later.
    valid : a window is there, which cannot be held back.
    window : its elements, the newest row first, columns from the left.
    companion : of the pixel ``after`` rows above the centre.
    sof, eol, eof : of the centre. Lines behind the frame have an end, and nothing else.
    damaged : the frame was mended somewhere up to the window's last pixel.
    """

    def __init__(
        self,
        element: ShapeLike,
        companion: ShapeLike,
        *,
        reach: int,
        depth: int,
        after: int,
        max_width: int,
        clocks: int = 1,
    ) -> None:
        self._element, self._companion = element, companion
        self._reach, self._depth, self._after, self._max_width = reach, depth, after, max_width
        self._across = 2 * reach + 1
        self.clocks, self.latency = clocks, self.latency_of(clocks)
        super().__init__(
            {
                "i": In(stream.Signature(raster_layout(element, companion))),
                "credit": In(1),
                "promised": Out(1),
                "valid": Out(1),
                "window": Out(data.ArrayLayout(data.ArrayLayout(element, self._across), depth + 1)),
                "companion": Out(companion),
                **{name: Out(1) for name in MARKERS},
            }
        )

    @staticmethod
    def latency_of(clocks: int) -> int:
        """Clocks from a slot to its window."""
        return FoldedMemory.latency_of(clocks) + 2

    def elaborate(self, platform: object) -> Module:
        m = Module()
        reach, depth, after, across = self._reach, self._depth, self._after, self._across
        slots = WindowSlots(
            m,
            self.i,
            self.credit,
            rows=reach,
            columns=reach,
            after=after,
            max_width=self._max_width,
            clocks=self.clocks,
        )
        m.d.comb += self.promised.eq(slots.slot & slots.emits)

        # When the memory's word is there, when the column, and when the window.
        found, entered_at, there = self.latency - 2, self.latency - 1, self.latency
        flags = data.StructLayout(
            {"top": 1, "flushing": 1, "x": range(self._max_width), **dict.fromkeys(MARKERS, 1)}
        )
        occurs = data.StructLayout({"new": 1, "slot": 1, "emits": 1})
        stages = [Signal(flags, name=f"flags_{k}", reset_less=True) for k in range(there + 1)]
        happens = [Signal(occurs, name=f"occurs_{k}") for k in range(there + 1)]
        pixel = [Signal(self._element, name=f"pixel_{k}", reset_less=True) for k in range(found + 1)]
        along = [Signal(self._companion, name=f"along_{k}", reset_less=True) for k in range(found + 1)]
        m.d.comb += [
            happens[0].new.eq(slots.slot & slots.new),
            happens[0].slot.eq(slots.slot),
            happens[0].emits.eq(self.promised),
            stages[0].top.eq(slots.top),
            stages[0].flushing.eq(slots.below.some),
            stages[0].x.eq(slots.x),
            stages[0].sof.eq(slots.sof),
            stages[0].eol.eq(slots.line_over),
            stages[0].eof.eq(slots.eof),
            stages[0].damaged.eq(slots.damage),
            pixel[0].eq(self.i.payload.element),
            along[0].eq(self.i.payload.companion),
        ]
        for k in range(there):
            m.d.sync += [stages[k + 1].eq(stages[k]), happens[k + 1].eq(happens[k])]
        for k in range(found):
            m.d.sync += [pixel[k + 1].eq(pixel[k]), along[k + 1].eq(along[k])]

        bits, along_bits = len(Value.cast(pixel[0])), len(Value.cast(along[0]))
        lag = reach + after
        word = data.StructLayout({"above": bits * depth, "along": along_bits * lag})
        m.submodules.lines = lines = FoldedMemory(word, self._max_width, self.clocks)
        above = lines.data.above
        newest = Value.cast(pixel[found])
        repeated = reach * bits  # of the rows above a frame's first
        column = Signal(bits * (depth + 1), reset_less=True)  # the newest row lowest
        trail = Signal(along_bits * (lag + 1), reset_less=True)
        with m.If(happens[found].new):
            m.d.sync += [
                column.eq(
                    Cat(
                        Mux(stages[found].flushing, above[:bits], newest),
                        Mux(stages[found].top, newest.replicate(reach), above[:repeated]),
                        above[repeated:],
                    )
                ),
                trail.eq(Cat(along[found], lines.data.along)),
            ]
        m.d.comb += [
            lines.read.eq(happens[0].new),
            lines.read_at.eq(stages[0].x),
            lines.write.eq(happens[found].new),
            lines.write_at.eq(stages[found].x),
            lines.written.above.eq(column),
            lines.written.along.eq(trail),
        ]

        past = [Signal(len(column), name=f"column_{k}", reset_less=True) for k in range(across)]
        trails = [Signal(along_bits, name=f"trail_{k}", reset_less=True) for k in range(reach + 1)]
        with m.If(happens[entered_at].slot):
            m.d.sync += [
                past[-1].eq(column),
                *(past[k].eq(past[k + 1]) for k in range(across - 1)),
                trails[-1].eq(trail[along_bits * lag :]),
                *(trails[k].eq(trails[k + 1]) for k in range(reach)),
            ]
        m.d.comb += [
            self.valid.eq(happens[there].emits),
            Value.cast(self.companion).eq(trails[0]),
            *(getattr(self, name).eq(stages[there][name]) for name in MARKERS),
            *(
                Value.cast(self.window[r][c]).eq(past[c][r * bits : (r + 1) * bits])
                for r in range(depth + 1)
                for c in range(across)
            ),
        ]
        return m
