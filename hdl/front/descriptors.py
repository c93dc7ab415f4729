"""What is known of each view's pixels before they are compared."""

from collections.abc import Iterable, Mapping, Sequence

from amaranth.hdl import Cat, Const, Module, Shape, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.census import CENSUS_REACH, SQUARES, Census
from softdepth.hdl.front.gradient import Gradient
from softdepth.hdl.front.luma import Colour, Luma, rest_bits
from softdepth.hdl.front.tall_window import TallWindow
from softdepth.hdl.memory.window import MARKERS, raster_layout
from softdepth.hdl.post.stage import delayed, window_stage

VIEWS = ("left", "right")
CENSUS, COLOUR = "census", "colour"
GRADIENT_REACH = 1


def reach_of(field: str) -> int:
    """Rows and columns around a pixel that its descriptor depends on."""
    return {CENSUS: CENSUS_REACH, COLOUR: 0}.get(field, GRADIENT_REACH)


def window_reach(fields: Iterable[str]) -> int:
    """The same of the window that all are computed from, which repeats the frame's edges at least once."""
    return max(1, *map(reach_of, fields))


def view_layout(caps: Mapping[str, int], rows: Mapping[str, Sequence[int]], pixel: int) -> data.StructLayout:
    """The descriptors of a column in one view: of each field one for each of its ``rows``."""
    shapes = {
        CENSUS: unsigned(len(SQUARES)),
        COLOUR: unsigned(pixel),
        **{k: Shape.cast(range(-c, c + 1)) for k, c in caps.items()},
    }
    return data.StructLayout({name: data.ArrayLayout(shapes[name], len(rows[name])) for name in rows})


def descriptors_latency(fields: Iterable[str]) -> int:
    """Clocks from the window to the descriptors."""
    return Gradient.latency if set(fields) - {CENSUS, COLOUR} else Census.latency


class Descriptors(wiring.Component):
    """Turns a raster of pixel pairs into one of descriptors of both views, the frame's edges repeated.

    Each pixel comes with descriptors of pixels above it. They are computed from the lumas of the rows
    around those, as a luma remembered takes a third of the memory of a census, and of one and a gradient
    a quarter; colours are remembered where they are compared. Behind a frame's lines there come ``after``
    more, for what is above them.
    A pixel every ``clocks`` clocks, but for twice the window's reach a line, and the reach and ``after`` in
    lines a frame.

    Parameters
    ----------
    channels, bits : of a pixel.
    rows : which descriptors are wanted, by name, and of how many rows above the pixel, ascending.
    caps : bounds of gradients, by name; ``census`` and ``colour``, the pixel itself, are none of them.
    after : lines behind a frame.

    Members
    -------
    i : `raster_layout` of both views' pixels, left lowest.
    o : the same raster and the lines behind it, of whose markers ``eol`` alone is ever high: ``left``,
        ``right`` are a `view_layout` each, ``colour`` is the left pixel ``after`` rows above.
    """

    def __init__(
        self,
        channels: int,
        bits: int,
        max_width: int,
        *,
        rows: Mapping[str, Sequence[int]],
        caps: Mapping[str, int],
        after: int,
        clocks: int = 1,
    ) -> None:
        self._channels, self._bits, self._max_width = channels, bits, max_width
        self._rows, self._caps, self._after, self._clocks = dict(rows), dict(caps), after, clocks
        pixel = channels * bits
        self.view = view_layout(caps, rows, pixel)
        members = {"left": self.view, "right": self.view, "colour": unsigned(pixel)}
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
        reach = window_reach(self._rows)
        rest = rest_bits(self._channels, self._bits)
        rests = [f"{name}_rest" for name in VIEWS] if coloured else []
        element = data.StructLayout(
            {**dict.fromkeys(VIEWS, unsigned(self._bits)), **dict.fromkeys(rests, unsigned(rest))}
        )
        window = TallWindow(
            element,
            unsigned(0 if coloured else rest),
            reach=reach,
            depth=reach + max(max(rows) + reach_of(name) for name, rows in self._rows.items()),
            after=self._after,
            max_width=self._max_width,
            clocks=self._clocks,
        )

        latency = descriptors_latency(self._rows)
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
                    if field == COLOUR:
                        m.d.comb += Value.cast(view[field][k]).eq(pixel_of(row, view_name))
                        continue
                    block = Census(self._bits) if field == CENSUS else Gradient(self._bits, self._caps[field])
                    m.submodules[f"{field}_{row}_{view_name}"] = block
                    near, middle = reach_of(field), reach + row
                    around = [
                        Value.cast(window.window[r][c][view_name])
                        for r in range(middle + near, middle - near - 1, -1)
                        for c in range(reach - near, reach + near + 1)
                    ]
                    late = delayed(
                        m, Value.cast(block.o), latency - block.latency, f"{field}_{row}_{view_name}"
                    )
                    m.d.comb += [
                        Value.cast(block.window).eq(Cat(*around)),
                        Value.cast(view[field][k]).eq(late),
                    ]
            results[view_name] = Value.cast(view)
        results["colour"] = pixel_of(self._after, "left")
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
