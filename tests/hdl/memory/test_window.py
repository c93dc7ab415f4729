"""Windows of frames of many sizes, back to back, against padded NumPy arrays."""

from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Module, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out
from numpy.typing import NDArray

from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.memory.window import MARKERS, Window, raster_layout
from tests.support.simulation import stream_through

BITS, ALONG = 6, 9
SIZES = [(1, 4), (5, 4), (2, 7), (9, 5), (3, 16), (1, 4), (6, 11)]


class Windows(wiring.Component):
    """A window between two streams."""

    def __init__(self, rows: int, columns: int, clocks: int) -> None:
        self.inner = Window(BITS, ALONG, rows, columns, 16, clocks=clocks)
        ports = ("window", "row_inside", "column_inside", "companion", *MARKERS)
        self.layout = data.StructLayout({p: getattr(self.inner, p).shape() for p in ports})
        super().__init__(
            {
                "i": In(stream.Signature(raster_layout(BITS, unsigned(ALONG)))),
                "o": Out(stream.Signature(self.layout)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.window = window = self.inner
        m.submodules.queue = queue = ResultQueue(self.layout, window.latency)
        wiring.connect(m, wiring.flipped(self.i), window.i)
        wiring.connect(m, queue.o, wiring.flipped(self.o))
        m.d.comb += [
            window.credit.eq(queue.credit),
            queue.promised.eq(window.promised),
            queue.put.eq(window.valid),
            *(queue.result[name].eq(getattr(window, name)) for name in self.layout.members),
        ]
        return m


def items(frame: NDArray[np.int64], damaged: int) -> list[int]:
    """A frame's transfers; ``damaged`` is the pixel from which on it is marked."""
    layout = raster_layout(BITS, unsigned(ALONG))
    height, width = frame.shape
    return [
        layout.const(
            {
                "element": int(frame[y, x]),
                "companion": (y * width + x) % 2**ALONG,
                "sof": (y, x) == (0, 0),
                "eol": x == width - 1,
                "eof": (y, x) == (height - 1, width - 1),
                "damaged": y * width + x >= damaged,
            }
        )
        .as_value()
        .value
        for y in range(height)
        for x in range(width)
    ]


@pytest.mark.parametrize(
    ("rows", "columns", "clocks"),
    [(1, 1, 1), (2, 2, 2), (3, 3, 1), (0, 4, 1), (3, 0, 2), (0, 0, 2), (4, 1, 1), (1, 2, 4)],
)
@pytest.mark.parametrize("rates", [(1.0, 1.0), (0.7, 0.5)])
def test_windows(rows: int, columns: int, clocks: int, rates: tuple[float, float]) -> None:
    rng = np.random.default_rng(rows * 10 + columns)
    frames = [rng.integers(0, 2**BITS, size) for size in SIZES]
    breaks = [9, 10**6, 5, 10**6, 20, 0, 10**6]
    sent = [word for frame, at in zip(frames, breaks, strict=True) for word in items(frame, at)]
    dut = Windows(rows, columns, clocks)
    found = iter(stream_through(dut, sent, i_rate=rates[0], o_rate=rates[1]).payloads)
    for frame, at in zip(frames, breaks, strict=True):
        height, width = frame.shape
        padded = np.pad(frame, ((rows, rows), (columns, columns)), mode="edge")
        inside = np.pad(np.ones_like(frame), ((rows, rows), (columns, columns)))
        for y in range(height):
            for x in range(width):
                got = next(found)
                here = (slice(y, y + 2 * rows + 1), slice(x, x + 2 * columns + 1))
                assert values(got.window) == padded[here].tolist(), (frame.shape, y, x)
                bits = inside[here]
                assert f"{got.row_inside:b}".zfill(len(bits))[::-1] == "".join(map(str, bits[:, columns]))
                assert f"{got.column_inside:b}".zfill(bits.shape[1])[::-1] == "".join(map(str, bits[rows]))
                assert got.companion == (y * width + x) % 2**ALONG
                assert bool(got.sof) == ((y, x) == (0, 0))
                assert bool(got.eol) == (x == width - 1)
                assert bool(got.eof) == ((y, x) == (height - 1, width - 1))
                last = min(y + rows, height - 1) * width + min(x + columns, width - 1)
                assert bool(got.damaged) >= (last >= at)
                assert not got.damaged or last + columns >= at or y + rows >= height - 1
    assert next(found, None) is None


def values(window: Any) -> list[list[int]]:
    return [[int(element) for element in row] for row in window]
