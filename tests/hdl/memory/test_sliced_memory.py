"""SlicedMemory: a word comes back whole, whatever it is cut into, and each slice fits one block RAM."""

import re
from random import Random
from typing import Any

import pytest
from amaranth.back import rtlil
from amaranth.hdl import ShapeLike, signed
from amaranth.lib import data

from softdepth.hdl.memory.sliced_memory import SlicedMemory
from tests.support.simulation import Ports, observe

BLOCK_BITS = 18 * 1024
PARITY = {1: 1, 2: 2, 4: 4, 9: 8, 18: 16, 36: 32}
"""Widths of a block RAM, and how wide it is without its parity bits."""


@pytest.mark.parametrize(
    ("bits", "depth"), [(1, 2), (36, 512), (37, 512), (50, 700), (20, 2000), (9, 4096), (11, 5000), (3, 9000)]
)
def test_words_come_back(bits: int, depth: int) -> None:
    """Reads and writes at the same time, at a few places; the output holds between reads."""
    random = Random(bits)
    places = [*random.sample(range(depth), min(depth, 6)), 0, depth - 1]
    stored: dict[int, int] = {}
    clocks: list[Ports] = []
    expected: list[int | None] = []
    output: int | None = None
    for _ in range(400):
        written_at = random.choice(places)
        read_at = random.choice([p for p in places if p != written_at])
        word, write, read = random.getrandbits(bits), random.getrandbits(1), random.getrandbits(1)
        clocks.append(
            {"read": read, "read_at": read_at, "write": write, "write_at": written_at, "written": word}
        )
        expected.append(output)
        if read:
            output = stored.get(read_at, 0)
        if write:
            stored[written_at] = word
    seen = observe(SlicedMemory(bits, depth), clocks, "data")
    compared = [(got, word) for got, word in zip(seen, expected, strict=True) if word is not None]
    assert len(compared) > 300
    assert all(got == word for got, word in compared)


@pytest.mark.parametrize("shape", [range(766), signed(40), data.ArrayLayout(10, 6)])
def test_any_shape(shape: ShapeLike) -> None:
    dut = SlicedMemory(shape, 600)
    value: Any = [k * 100 for k in range(6)] if isinstance(shape, data.ArrayLayout) else 57
    clocks: list[Ports] = [
        {"write": 1, "write_at": 3, "written": value},
        {"write": 0, "read": 1, "read_at": 3},
        {},
    ]
    word = observe(dut, clocks, "data")[-1]
    assert (list(dut.data.shape().from_bits(word)) if isinstance(value, list) else word) == value


@pytest.mark.parametrize(
    ("bits", "depth"),
    [(1, 8), (36, 512), (288, 512), (20, 513), (18, 1024), (288, 1280), (20, 4096), (20, 5120), (3, 20480)],
)
def test_a_slice_is_a_block_as_deep_as_the_memory(bits: int, depth: int) -> None:
    """So that no logic chooses between blocks, as long as a block is that deep at all."""
    text = rtlil.convert(SlicedMemory(bits, depth), emit_src=False)
    slices = [(int(w), int(n)) for w, n in re.findall(r"memory width (\d+) size (\d+)", text)]
    assert sum(width for width, _ in slices) == bits
    for width, size in slices:
        assert size == depth
        wide = next(w for w in PARITY if w >= width)
        deep = BLOCK_BITS // 36 * 32 // PARITY[wide]
        assert depth <= deep or (depth > 16384 and width == 1)
    assert len({width for width, _ in slices[:-1]}) <= 1


def test_slices_share_the_word() -> None:
    """No more slices than the widest would take, and none wider than need be: 32 bits are blocks of 8."""
    text = rtlil.convert(SlicedMemory(96, 320), emit_src=False)
    assert re.findall(r"memory width (\d+)", text) == ["32", "32", "32"]
