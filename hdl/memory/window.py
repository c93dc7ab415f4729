"""Windows of a raster: each pixel with its neighbours, up to the frame's last."""

from amaranth.hdl import Cat, Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.folded_memory import FoldedMemory
from softdepth.hdl.memory.window_slots import WindowSlots

MARKERS = ("sof", "eol", "eof", "damaged")
"""A raster's markers: first pixel, last of a line, last of all, and whether the frame was mended so far."""


def raster_layout(element: ShapeLike, companion: ShapeLike = 0) -> data.StructLayout:
    """What a `Window` takes: an element, what travels with it, and the markers of a sound frame."""
    return data.StructLayout({"element": element, "companion": companion, **dict.fromkeys(MARKERS, 1)})


class Window(wiring.Component):
    """Gives each pixel of a frame the window around it, ``2 rows + 1`` by ``2 columns + 1``.

    Outside the frame, its edge is repeated; `row_inside` and `column_inside` are for those who would
    rather leave that out. There is no multiplexer in the window: a line's first and last columns enter
    ``columns`` more times, a frame's first row enters into all rows of its column, and below its last
    row the column's newest pixel enters again. So a line takes ``2 columns`` more slots than it has
    pixels, and a frame ``rows`` more lines, in which the input is held back; nothing waits for the
    next frame.

    Parameters
    ----------
    element, companion : what is wanted of all the window's pixels, and what is wanted of the centre alone.
    rows, columns : reach of the window, the same above and below, and the same left and right.
    max_width : pixels of the longest line; the shortest has 4.
    clocks : the fewest that a slot takes; with more than one, memory is smaller (`FoldedMemory`).

    Members
    -------
    i : a raster.
    credit : a window may be begun in this clock.
    promised : a window is begun: it leaves `latency` clocks later.
    valid : a window is there, which cannot be held back.
    window : its elements, rows from above, columns from the left.
    row_inside, column_inside : which rows and columns of it lie inside the frame.
    companion, sof, eol, eof : of the window's centre.
    damaged : the frame was mended somewhere up to the window's last pixel.
    """

    def __init__(
        self,
        element: ShapeLike,
        companion: ShapeLike,
        rows: int,
        columns: int,
        max_width: int,
        *,
        clocks: int = 1,
    ) -> None:
        self._rows, self._columns, self._max_width = rows, columns, max_width
        self._element, self._companion = element, companion
        self._height, self._across = 2 * rows + 1, 2 * columns + 1
        self.clocks, self.latency = clocks, self.latency_of(clocks)
        super().__init__(
            {
                "i": In(stream.Signature(raster_layout(element, companion))),
                "credit": In(1),
                "promised": Out(1),
                "valid": Out(1),
                "window": Out(data.ArrayLayout(data.ArrayLayout(element, self._across), self._height)),
                "row_inside": Out(self._height),
                "column_inside": Out(self._across),
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
        rows, columns, height, across = self._rows, self._columns, self._height, self._across
        slots = WindowSlots(
            m,
            self.i,
            self.credit,
            rows=rows,
            columns=columns,
            max_width=self._max_width,
            clocks=self.clocks,
        )
        slot, below = slots.slot, slots.below
        m.d.comb += self.promised.eq(slot & slots.emits)
        frame_rows = Signal(height)  # which rows of the column lie inside the frame
        with m.If(slot & slots.starts):
            m.d.sync += frame_rows.eq(1 << (height - 1))
        with m.If(slot & slots.line_over):
            m.d.sync += frame_rows.eq(Cat(frame_rows[1:], ~below.some & ~slots.ended))

        # Clocks at which the memory's word is there, the column, and the window.
        found, entered_at, there = self.latency - 2, self.latency - 1, self.latency
        flags = data.StructLayout(
            {
                "new": 1,
                "slot": 1,
                "emits": 1,
                "top": 1,
                "flushing": 1,
                "inside": 1,
                "x": range(self._max_width),
                "rows": height,
                **dict.fromkeys(MARKERS, 1),
            }
        )
        occurs = data.StructLayout({"new": 1, "slot": 1, "emits": 1})
        stages = [Signal(flags, name=f"flags_{k}", reset_less=True) for k in range(there + 1)]
        happens = [Signal(occurs, name=f"occurs_{k}") for k in range(there + 1)]
        pixel = [Signal(self._element, name=f"pixel_{k}", reset_less=True) for k in range(found + 1)]
        along = [Signal(self._companion, name=f"along_{k}", reset_less=True) for k in range(found + 1)]
        m.d.comb += [
            happens[0].new.eq(slot & slots.new),
            happens[0].slot.eq(slot),
            happens[0].emits.eq(self.promised),
            stages[0].top.eq(slots.top),
            stages[0].flushing.eq(below.some),
            stages[0].inside.eq(slots.inside),
            stages[0].x.eq(slots.x),
            stages[0].rows.eq(Mux(slots.starts, 1 << (height - 1), frame_rows)),
            stages[0].sof.eq(slots.sof),
            stages[0].eol.eq(slots.line_over),
            stages[0].eof.eq(slots.eof),
            stages[0].damaged.eq(slots.damaged),
            pixel[0].eq(self.i.payload.element),
            along[0].eq(self.i.payload.companion),
        ]
        for k in range(there):
            m.d.sync += [stages[k + 1].eq(stages[k]), happens[k + 1].eq(happens[k])]
        for k in range(found):
            m.d.sync += [pixel[k + 1].eq(pixel[k]), along[k + 1].eq(along[k])]

        element_bits, along_bits = len(Value.cast(pixel[0])), len(Value.cast(along[0]))
        newest = Value.cast(pixel[found])
        column = Signal(element_bits * height)  # the newest row last
        held = Signal.like(column, reset_less=True)
        trail = Signal(max(along_bits, 1) * (rows + 1))
        held_trail = Signal.like(trail, reset_less=True)
        if rows:
            word = data.StructLayout({"above": element_bits * 2 * rows, "along": along_bits * rows})
            m.submodules.lines = lines = FoldedMemory(word, self._max_width, self.clocks)
            above = lines.data.above
            entering = Mux(stages[found].flushing, above[-element_bits:], newest)
            m.d.comb += [
                lines.read.eq(happens[0].new),
                lines.read_at.eq(stages[0].x),
                column.eq(Mux(stages[found].top, newest.replicate(height), Cat(above, entering))),
                trail.eq(Cat(lines.data.along, Value.cast(along[found]))),
                lines.write.eq(happens[found].new),
                lines.write_at.eq(stages[found].x),
                lines.written.above.eq(held[element_bits:]),
                lines.written.along.eq(held_trail[along_bits:]),
            ]
        else:
            m.d.comb += [column.eq(newest), trail.eq(Value.cast(along[found]))]
        with m.If(happens[found].new):
            m.d.sync += [held.eq(column), held_trail.eq(trail)]

        past = [Signal(element_bits * height, name=f"column_{k}", reset_less=True) for k in range(across)]
        insides = Signal(across, reset_less=True)
        trails = [Signal(max(along_bits, 1), name=f"trail_{k}", reset_less=True) for k in range(columns + 1)]
        with m.If(happens[entered_at].slot):
            m.d.sync += [
                past[-1].eq(held),
                *(past[k].eq(past[k + 1]) for k in range(across - 1)),
                insides.eq(Cat(insides[1:], stages[entered_at].inside)),
                trails[-1].eq(held_trail[: max(along_bits, 1)]),
                *(trails[k].eq(trails[k + 1]) for k in range(columns)),
            ]
        m.d.comb += [
            self.valid.eq(happens[there].emits),
            self.row_inside.eq(stages[there].rows),
            self.column_inside.eq(insides),
            Value.cast(self.companion).eq(trails[0]),
            *(getattr(self, name).eq(stages[there][name]) for name in MARKERS),
        ]
        for r in range(height):
            for c in range(across):
                part = past[c][r * element_bits : (r + 1) * element_bits]
                m.d.comb += Value.cast(self.window[r][c]).eq(part)
        return m
