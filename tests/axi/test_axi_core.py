"""The AXI core by sources, sinks and masters that others wrote, against the fixed model in every bit."""

import os
from pathlib import Path
from random import Random

import numpy as np
import pytest

from tests.axi.runs import SMALL, Steps, expected, run
from tests.cocotb.scenes import textured
from tests.support.broken_video import broken_video
from tests.support.fault_table import mended

FRAMES = int(os.environ.get("SOFTDEPTH_SOAK", "8"))
DAMAGED = np.uint64(1 << 23)
pytestmark = pytest.mark.slow


def test_random_frames_and_registers_in_mid_frame(tmp_path: Path) -> None:
    """Each frame has the settings that were written during the frame before, whole."""
    random = Random(1)
    steps, wanted = Steps(), []
    config, floor, invalid, height = SMALL, 0, 0, 0
    for number in range(FRAMES):
        width = random.randrange(SMALL.min_width, SMALL.max_width + 1)
        # Two equal heights in a row would teach the core that all frames are as high.
        height = random.choice([n for n in range(3, SMALL.max_height + 1) if n != height])
        left, right = textured(height, width, number)
        wanted.append(expected(left, right, config, floor=floor, invalid=invalid))
        middle = random.randrange(1, height)
        steps.lines(left, right, range(middle))
        tolerance, island = random.randrange(3), random.randrange(12)
        truncation, like = random.randrange(2, 17), random.choice((1, 5, 20, 33, 256))
        config = SMALL.override(
            [
                *(f"post.tolerance={tolerance}", f"post.island={island}", f"post.like={like}"),
                f"criteria.0.truncation={truncation}",
            ]
        )
        floor, invalid = random.choice((0, 10, 60)), random.choice((0, 0xFFFF, 0x7FF))
        for name, value in (
            ("CHECK", tolerance),
            ("ISLAND", island),
            ("TRUNCATION", truncation),
            ("LIKENESS", like),
            ("CONFIDENCE", floor),
            ("INVALID", invalid),
        ):
            steps.write(name, value)
        steps.lines(left, right, range(middle, height))
    # A last frame ends the one before: nothing has told the height.
    steps.lines(*textured(2, SMALL.min_width, 99), range(2))
    out = run(steps, tmp_path, seed=3, idle=0.2, pressure=0.3)
    for number, (want, got) in enumerate(zip(wanted, out.frames, strict=False)):
        assert got.shape == want.shape, number
        assert np.array_equal(got, want), (number, np.argwhere(got != want)[:3])
    assert len(out.frames) >= FRAMES
    assert out.registers["FRAMES"] == FRAMES
    seen = out.registers["SEEN"]
    assert (seen >> 16, seen & 0xFFFF) == wanted[-1].shape
    assert out.registers["FLAGS"] == 1
    assert not out.irq
    assert out.registers["IDENTITY"].to_bytes(4, "big") == b"SDPT"
    assert f"{out.registers['CONFIG_HIGH']:04x}{out.registers['CONFIG_LOW']:08x}" == SMALL.hash


def test_a_height_that_is_set_ends_the_first_frame(tmp_path: Path) -> None:
    """Neither lines nor the frame's end are marked; what follows while it is off is dropped."""
    left, right = textured(7, 12, 5)
    steps = Steps()
    steps.write("GEOMETRY", 7 << 16 | 12)
    steps.write("INTERRUPTS", 1)
    steps.line(left.reshape(-1, 3), right.reshape(-1, 3), True)
    steps.write("CONTROL", 0)
    steps.line(left.reshape(-1, 3), right.reshape(-1, 3), True)
    out = run(steps, tmp_path)
    assert len(out.frames) == 1
    assert np.array_equal(out.frames[0], expected(left, right))
    assert out.irq == 1
    assert out.registers["STATUS"] == 0


def test_a_height_that_is_no_longer_set_is_learnt(tmp_path: Path) -> None:
    """Frames then end with the next one's start, and are whole; two that are equally high tell the end."""
    heights = [7, 4, 5, 5, 5]
    pairs = [textured(height, 12, number) for number, height in enumerate(heights)]
    steps = Steps()
    steps.write("GEOMETRY", heights[0] << 16)
    steps.lines(*pairs[0], range(heights[0]))
    steps.write("GEOMETRY", 0)
    for number in range(1, len(heights)):
        steps.lines(*pairs[number], range(heights[number]))
    out = run(steps, tmp_path)
    assert len(out.frames) == len(heights)
    for got, (left, right) in zip(out.frames, pairs, strict=True):
        assert np.array_equal(got, expected(left, right))
    assert out.registers["FLAGS"] == 1


@pytest.mark.parametrize("seed", [1, 3, 5, 7])
def test_broken_video(seed: int, tmp_path: Path) -> None:
    """The table of docs/gateware.md, in which a source without ``eof`` can break."""
    stream, _ = broken_video(seed, SMALL)
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 60, (2, len(stream) + 1, 3), dtype=np.uint8)
    steps, begin = Steps(), 0
    for k, sent in enumerate(stream, start=1):
        if sent.eol:
            values = [each.value for each in stream[begin:k]]
            steps.line(*pixels[:, values], *(each.sof for each in stream[begin:k]))
            begin = k
    found = mended(stream, SMALL)
    closed = [frame for frame in found.frames if frame.end != "open"]
    out = run(steps, tmp_path, seed=seed, idle=0.1, pressure=0.1)
    for number, frame in enumerate(closed):
        left, right = pixels[:, np.array(frame.lines)]
        got = out.frames[number]
        assert np.array_equal(got & ~DAMAGED, expected(left, right)), number
        # From the fault on at the latest: results see pixels below and right of their own.
        marked = (got & DAMAGED != 0).ravel()
        due = np.array(frame.damaged[: marked.size])
        assert (marked | ~due).all()
        assert (marked[1:] >= marked[:-1]).all()
        assert marked[-1] == frame.damaged[-1]
    for name in ("short_lines", "long_lines", "early_starts", "missing_starts"):
        assert out.registers[name.upper()] == found.counters.get(name, 0), name
