"""Memories made of segments: every word comes back, and they take as few blocks as they should."""

import numpy as np
import pytest
from amaranth.back import rtlil
from amaranth.hdl import unsigned

from softdepth.hdl.memory.packed_memory import PackedMemory, blocks, segments_of
from softdepth.hdl.text.collisions import waive_collisions
from tests.support.simulation import observe


@pytest.mark.parametrize(("depth", "bits"), [(5, 3), (1300, 20), (2600, 13)])
def test_words_come_back(depth: int, bits: int) -> None:
    rng = np.random.default_rng(depth)
    words = rng.integers(0, 2**bits, depth)
    edges = {k for edge in np.cumsum(segments_of(bits, depth)) for k in (edge - 1, edge) if k < depth}
    places = sorted({0, depth - 1, *(int(k) for k in edges), *map(int, rng.integers(0, depth, 100))})
    clocks = [{"write": 1, "write_at": k, "written": int(words[k])} for k in places]
    rng.shuffle(places)
    reads = [{"write": 0, "read": 1, "read_at": k} for k in places]
    dut = PackedMemory(unsigned(bits), depth)
    found = observe(dut, [*clocks, *reads, {"read": 0}, *[{}] * dut.latency], "data")
    first = len(places) + dut.latency
    assert found[first : first + len(places)] == [int(words[k]) for k in places]


@pytest.mark.parametrize(
    ("bits", "depth", "expected"), [(60, 2560, 9), (9, 2048, 1), (96, 1280, 9), (10, 1024, 1), (36, 300, 1)]
)
def test_blocks(bits: int, depth: int, expected: int) -> None:
    assert blocks(bits, depth) == expected


def test_collisions_are_waived_in_every_segment() -> None:
    """Else synthesis builds logic that gives the old word to a read that meets a write."""
    text = rtlil.convert(PackedMemory(unsigned(40), 1300), emit_src=False)
    assert "COLLISION_X_MASK 1'0" in text
    assert "COLLISION_X_MASK 1'0" not in waive_collisions(text)
