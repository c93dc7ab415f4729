"""What is computed for each view's pixels before they are compared."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from amaranth.hdl import Cat, Const, Module, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import coarse
from softdepth.hdl.front.descriptor import COLOUR, Descriptor
from softdepth.hdl.front.luma import Colour, Luma, rest_bits
from softdepth.hdl.front.tall_window import TallWindow
from softdepth.hdl.memory.delay import delayed
from softdepth.hdl.memory.window import MARKERS, raster_layout
from softdepth.hdl.memory.window_stage import window_stage

VIEWS = ("left", "right")


def window_reach(descriptors: Iterable[Descriptor]) -> int:
    """Rows and columns around a pixel of the window that all are computed from: it repeats the frame's edges
    at least once."""
    return max(1, *(each.reach for each in descriptors))


def view_layout(descriptors: Iterable[Descriptor], rows: Mapping[str, Sequence[int]]) -> data.StructLayout:
    """The descriptors of a column in one view: of each one for each of its ``rows``."""
    shapes = {each.name: each.shape for each in descriptors}
    return data.StructLayout({name: data.ArrayLayout(shapes[name], len(rows[name])) for name in rows})


def descriptors_latency(descriptors: Iterable[Descriptor]) -> int:
    """Clocks from the window to the descriptors."""
    return max(1, *(each.latency for each in descriptors))


class Descriptors(wiring.Component):
    """Turns a raster of pixel pairs into one of descriptors of both views, the frame's edges repeated.

    Each pixel comes with descriptors of pixels above it. They are computed from the lumas of the rows around
    those, as a luma remembered takes a third of the memory of a census, and of one and a gradient a quarter;
    colours are remembered where they are compared. After a frame's lines there are ``after`` more, for the
    pixels above them. One pixel every ``clocks`` clocks, except for twice the window's reach per line, and
    reach plus ``after`` lines per frame.

    Parameters
    ----------
    channels, bits : of a pixel.
    colour_bits : how many bits of each of the left pixel's channels go on, the highest.
    descriptors : which are wanted.
    rows : by their names, of how many rows above the pixel, ascending.
    after : lines behind a frame.

    Members
    -------
    i : `raster_layout` of both views' pixels, left lowest.
    o : the same raster and the lines behind it, of whose markers ``eol`` alone is ever high: ``left``,
        ``right`` are a `view_layout` each, ``colour`` is of the left pixel ``after`` rows above.
    """

    def __init__(
        self,
        channels: int,
        bits: int,
        max_width: int,
        *,
        colour_bits: int,
        descriptors: Sequence[Descriptor],
        rows: Mapping[str, Sequence[int]],
        after: int,
        clocks: int = 1,
    ) -> None:
        self._channels, self._bits, self._max_width = channels, bits, max_width
        self._rows, self._after, self._clocks = dict(rows), after, clocks
        self._descriptors = {each.name: each for each in descriptors}
        pixel, self._colour_bits = channels * bits, colour_bits
        self.view = view_layout(descriptors, rows)
        members = {"left": self.view, "right": self.view, "colour": unsigned(channels * colour_bits)}
        self.layout = data.StructLayout({**members, **dict.fromkeys(MARKERS, 1)})
        super().__init__(
            {
                "i": In(stream.Signature(raster_layout(unsigned(2 * pixel)))),
                "o": Out(stream.Signature(self.layout)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pixel = self._channels * self._bits
        lumas = []
        coloured = COLOUR in self._rows
        for k, name in enumerate(VIEWS):
            m.submodules[f"luma_{name}"] = luma = Luma(self._channels, self._bits)
            m.d.comb += luma.i.eq(self.i.payload.element[k * pixel : (k + 1) * pixel])
            lumas.append(luma)
        known = self._descriptors
        reach = window_reach(known.values())
        rest = rest_bits(self._channels, self._bits)
        rests = [f"{name}_rest" for name in VIEWS] if coloured else []
        element = data.StructLayout(
            {**dict.fromkeys(VIEWS, unsigned(self._bits)), **dict.fromkeys(rests, unsigned(rest))}
        )
        window = TallWindow(
            element,
            unsigned(0 if coloured else rest),
            reach=reach,
            depth=reach + max(max(rows) + known[name].reach for name, rows in self._rows.items()),
            after=self._after,
            max_width=self._max_width,
            clocks=self._clocks,
        )

        latency = descriptors_latency(known.values())
        pixels: dict[tuple[int, str], Value] = {}

        def pixel_of(row: int, view_name: str) -> Value:
            """The pixel so many rows above, as late as the descriptors."""
            if (row, view_name) not in pixels:
                m.submodules[f"colour_{row}_{view_name}"] = colour = Colour(self._channels, self._bits)
                place = window.window[reach + row][reach]
                m.d.comb += [
                    colour.i.eq(place[view_name]),
                    colour.rest.eq(place[f"{view_name}_rest"] if coloured else window.companion),
                ]
                pixels[row, view_name] = delayed(m, colour.o, latency, f"colour_{row}_{view_name}")
            return pixels[row, view_name]

        results: dict[str, Value] = {}
        for view_name in VIEWS:
            view = Signal(self.view, name=view_name)
            for field, rows in self._rows.items():
                for k, row in enumerate(rows):
                    make = known[field].block
                    if make is None:
                        m.d.comb += Value.cast(view[field][k]).eq(pixel_of(row, view_name))
                        continue
                    block: Any = make(self._bits)
                    m.submodules[f"{field}_{row}_{view_name}"] = block
                    near, middle = known[field].reach, reach + row
                    around = [
                        Value.cast(window.window[r][c][view_name])
                        for r in range(middle + near, middle - near - 1, -1)
                        for c in range(reach - near, reach + near + 1)
                    ]
                    late = delayed(
                        m, Value.cast(block.o), latency - known[field].latency, f"{field}_{row}_{view_name}"
                    )
                    m.d.comb += [
                        Value.cast(block.window).eq(Cat(*around)),
                        Value.cast(view[field][k]).eq(late),
                    ]
            results[view_name] = Value.cast(view)
        results["colour"] = coarse(pixel_of(self._after, "left"), self._channels, self._colour_bits)
        window_stage(
            m,
            self.i,
            self.o,
            window,
            latency,
            element=Cat(*(luma.o for luma in lumas), *(luma.rest for luma in lumas if coloured)),
            companion=Const(0, 0) if coloured else lumas[0].rest,
            results=results,
        )
        return m
