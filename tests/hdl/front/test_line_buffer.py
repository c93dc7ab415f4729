"""LineBuffer: columns over several frames of different widths, with gaps between pixels."""

from random import Random

import pytest

from softdepth.hdl.front.line_buffer import LineBuffer
from tests.support.simulation import Ports, observe

WIDTH_BITS = 10
MAX_WIDTH = 11


@pytest.mark.parametrize("rate", [1.0, 0.5])
@pytest.mark.parametrize("rows", [1, 2, 3, 5, 7])
def test_column_ends_in_the_new_pixel(rows: int, rate: float) -> None:
    random = Random(rows)
    idle: Ports = {"en": 0}
    clocks: list[Ports] = []
    entered: list[tuple[int, list[int]]] = []  # the clock of each pixel, and the column it completes
    for width, height in [(7, rows + 2), (MAX_WIDTH, rows + 1), (3, rows + 3), (5, 1), (5, rows + 2)]:
        image = [[random.getrandbits(WIDTH_BITS) for _ in range(width)] for _ in range(height)]
        for y in range(height):
            for x in range(width):
                while random.random() >= rate:
                    clocks.append({**idle, "x": random.randrange(MAX_WIDTH), "pixel": random.getrandbits(8)})
                entered.append((len(clocks), [image[row][x] for row in range(max(y - rows + 1, 0), y + 1)]))
                clocks.append({"en": 1, "x": x, "pixel": image[y][x]})
    dut = LineBuffer(WIDTH_BITS, rows, MAX_WIDTH)
    clocks += [idle] * (dut.latency + 5)
    seen = observe(dut, clocks, "column")

    until = [clock + dut.latency for clock, _ in entered[1:]] + [len(clocks)]
    for (clock, column), end in zip(entered, until, strict=True):
        for bits in seen[clock + dut.latency : end]:  # held until the next
            words = [bits >> WIDTH_BITS * row & 2**WIDTH_BITS - 1 for row in range(rows)]
            assert words[rows - len(column) :] == column
    assert any(len(column) == rows for _, column in entered)


def test_bits_of_memory() -> None:
    assert observe(LineBuffer(48, 1, 640), [{}], "column")
    sizes = [(48, 3, 640), (1, 2, 2), (24, 7, 1280)]
    buffers = [LineBuffer(*size) for size in sizes]
    assert [b.bits for b in buffers] == [w * (rows - 1) * width for w, rows, width in sizes]
    for b in buffers:
        observe(b, [{}], "column")
