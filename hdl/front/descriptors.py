"""What is known of each view's pixels before they are compared."""

from collections.abc import Mapping

from amaranth.hdl import Cat, Module, Shape, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.census import CENSUS_REACH, SQUARES, Census
from softdepth.hdl.front.gradient import Gradient
from softdepth.hdl.front.luma import Luma
from softdepth.hdl.memory.window import MARKERS, Window, raster_layout
from softdepth.hdl.post.stage import delayed, window_stage

VIEWS = ("left", "right")


def view_layout(caps: Mapping[str, int], *, census: bool) -> data.StructLayout:
    """The descriptors of a pixel in one view: its census, and a gradient for each of ``caps``."""
    shapes: dict[str, Shape] = {"census": unsigned(len(SQUARES))} if census else {}
    shapes |= {name: Shape.cast(range(-cap, cap + 1)) for name, cap in caps.items()}
    return data.StructLayout(shapes)


class Descriptors(wiring.Component):
    """Turns a raster of pixel pairs into one of descriptors of both views, the frame's edges repeated.

    A pixel a clock, but for twice the window's reach a line and the reach in lines a frame.

    Parameters
    ----------
    channels, bits : of a pixel.
    census : it is wanted.
    caps : bounds of the gradients that are wanted, by name.

    Members
    -------
    i : `raster_layout` of both views' pixels, left lowest.
    o : the same raster: ``left``, ``right`` are a `view_layout` each, ``colour`` is the left pixel.
    """

    def __init__(
        self, channels: int, bits: int, max_width: int, *, census: bool, caps: Mapping[str, int]
    ) -> None:
        self._channels, self._bits, self._max_width = channels, bits, max_width
        self._census, self._caps = census, dict(caps)
        pixel = channels * bits
        self.view = view_layout(caps, census=census)
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
        for k, name in enumerate(VIEWS):
            m.submodules[f"luma_{name}"] = luma = Luma(self._channels, self._bits)
            m.d.comb += luma.i.eq(self.i.payload.element[k * pixel : (k + 1) * pixel])
            lumas.append(luma.o)
        reach = CENSUS_REACH if self._census else 1
        element = data.StructLayout(dict.fromkeys(VIEWS, unsigned(self._bits)))
        window = Window(element, unsigned(pixel), reach, reach, self._max_width)

        latency = Gradient.latency if self._caps else Census.latency
        results: dict[str, Value] = {}
        for name in VIEWS:
            rows = [[element[name] for element in row] for row in window.window]
            view = Signal(self.view, name=name)
            if self._census:
                m.submodules[f"census_{name}"] = census = Census(self._bits)
                m.d.comb += Value.cast(census.window).eq(Cat(*(Cat(*row) for row in rows)))
                late = delayed(m, census.o, latency - Census.latency, f"census_{name}")
                m.d.comb += view.census.eq(late)
            middle = [row[reach - 1 : reach + 2] for row in rows[reach - 1 : reach + 2]]
            for field, cap in self._caps.items():
                m.submodules[f"{field}_{name}"] = gradient = Gradient(self._bits, cap)
                m.d.comb += [
                    Value.cast(gradient.window).eq(Cat(*(Cat(*row) for row in middle))),
                    view[field].eq(gradient.o),
                ]
            results[name] = Value.cast(view)
        results["colour"] = delayed(m, Value.cast(window.companion), latency, "colour")
        window_stage(
            m,
            self.i,
            self.o,
            window,
            latency,
            element=Cat(*lumas),
            companion=self.i.payload.element[:pixel],
            results=results,
        )
        return m
