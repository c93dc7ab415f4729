"""Descriptors of both views, against loops, frames of all sizes back to back; and ends of frames."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from softdepth.hdl.front.descriptor import CENSUS, gradient
from softdepth.hdl.front.descriptors import Descriptors
from softdepth.hdl.front.frame_ends import FrameEnds
from softdepth.hdl.memory.window import raster_layout
from tests.support.results import markers
from tests.support.simulation import config, stream_through

SIZES = [(7, 9), (1, 4), (3, 5), (12, 16)]
PIXEL = 24
AFTER = 4


def luma(pixel: NDArray[np.int64]) -> int:
    return int(pixel[0] + 2 * pixel[1] + pixel[2]) >> 2


@pytest.mark.parametrize(("clocks", "kept", "rates"), [(1, 8, (1.0, 1.0)), (2, 5, (0.6, 0.4))])
def test_descriptors(clocks: int, kept: int, rates: tuple[float, float]) -> None:
    rng = np.random.default_rng(1)
    contrasts = (256, 20, 256, 40)
    frames = [rng.integers(0, c, (2, *size, 3)) for size, c in zip(SIZES, contrasts, strict=True)]
    layout = raster_layout(2 * PIXEL)
    sent = []
    for frame in frames:
        _, height, width, _ = frame.shape
        for y in range(height):
            for x in range(width):
                word = sum(int(v) << 8 * k for k, v in enumerate(frame[:, y, x].reshape(-1)))
                item = layout.const({"element": word, **markers(y, x, height, width)})
                sent.append(item.as_value().value)
    rows = {"census": (0, 9), "narrow": (2, 7), "wide": (1,)}
    known = (CENSUS, replace(gradient(31), name="narrow"), replace(gradient(100), name="wide"))
    dut = Descriptors(3, 8, 16, colour_bits=kept, descriptors=known, rows=rows, after=AFTER, clocks=clocks)
    found = iter(stream_through(dut, sent, i_rate=rates[0], o_rate=rates[1]).payloads)
    for frame in frames:
        _, height, width, _ = frame.shape
        lumas = [[[luma(p) for p in row] for row in view] for view in frame]
        for y, x in np.ndindex(height + AFTER, width):
            got = next(found)
            for view, name in zip(lumas, ("left", "right"), strict=True):

                def at(dy: int, dx: int, view: list = view, x: int = x) -> int:
                    """Around a column, at a row of the frame."""
                    row = min(max(dy, 0), len(view) - 1)
                    return view[row][min(max(x + dx, 0), len(view[0]) - 1)]

                for k, above in enumerate(rows["census"]):
                    if 0 <= (row := y - above) < height:
                        around = [
                            (dy, dx) for dy in range(-3, 4) for dx in range(-3, 4) if (dy + dx) % 2 == 0
                        ]
                        around.remove((0, 0))
                        census = sum(
                            (at(row + dy, dx) < at(row, 0)) << k for k, (dy, dx) in enumerate(around)
                        )
                        assert got[name].census[k] == census, (y, x, above)
                for field, cap in (("narrow", 31), ("wide", 100)):
                    for k, above in enumerate(rows[field]):
                        if 0 <= (row := y - above) < height:
                            sides = [at(row + dy, 1) - at(row + dy, -1) for dy in (-1, 0, 1)]
                            sobel = sides[0] + 2 * sides[1] + sides[2]
                            assert got[name][field][k] == min(max(sobel, -cap), cap), (y, x, above)
            if y - AFTER >= 0:
                pixel = frame[0, y - AFTER, x]
                assert got.colour == sum(int(v) >> 8 - kept << kept * k for k, v in enumerate(pixel))
            expected = markers(y, x, height, width) if y < height else {"eol": x == width - 1}
            for marker in ("sof", "eol", "eof"):
                assert got[marker] == expected.get(marker, False), (y, x, marker)
    assert next(found, None) is None


@pytest.mark.parametrize("rates", [(1.0, 1.0), (0.5, 0.6)])
def test_frame_ends(rates: tuple[float, float]) -> None:
    dut = FrameEnds(config(criteria=[{"window": 3}], cost="sum"))
    layout = dut.i.payload.shape()
    sent, expected = [], []
    for number, bare in enumerate((False, True, True, False)):
        for k in range(8):
            last = k == 7
            item = {"left": 8 * number + k, "sof": k == 0, "eol": k % 4 == 3, "eof": last and not bare}
            sent.append(layout.const(item).as_value().value)
            damaged = last and bare and number == 2
            expected.append((8 * number + k, k == 0, k % 4 == 3, last, damaged))
        if bare:
            sent.append(layout.const({"end": 1, "damaged": number == 2}).as_value().value)
    found = stream_through(dut, sent, i_rate=rates[0], o_rate=rates[1]).payloads
    assert [(p.element, p.sof, p.eol, p.eof, p.damaged) for p in found] == expected
