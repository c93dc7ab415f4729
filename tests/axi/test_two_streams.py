"""A stream a view, each of its own clock, by cocotbext-axi: skew, and faults in either."""

from pathlib import Path
from random import Random

import numpy as np
import pytest
from numpy.typing import NDArray

from softdepth.golden.front.pair import Image
from tests.axi.runs import PAPER, Steps, expected, run
from tests.axi.test_axi_core import DAMAGED
from tests.cocotb.scenes import textured
from tests.support.broken_video import Stream
from tests.support.fault_table import Sent, mended
from tests.support.paired_video import broken_views, joined

CONFIG = PAPER.config
SKEW = CONFIG.max_width * PAPER.options.skew
pytestmark = pytest.mark.slow


def results(left: Image, right: Image) -> NDArray[np.uint64]:
    return expected(left, right, CONFIG)


def test_views_that_come_as_they_like(tmp_path: Path) -> None:
    """Random idle in each, and clocks of random periods: nothing is lost, doubled, or paired with another.

    The compensating rule's threshold is written in mid-frame, where the frame's start has left the queues.
    """
    random = Random(2)
    steps, wanted = Steps(PAPER), []
    config, height, differ = CONFIG, 0, 0
    for number in range(6):
        width = random.randrange(CONFIG.max_width - 8, CONFIG.max_width + 1)
        height = random.choice([n for n in range(5, CONFIG.max_height + 1) if n != height])
        left, right = textured(height, width, number)
        wanted.append(expected(left, right, config))
        differ += not np.array_equal(wanted[-1], results(left, right))
        middle = PAPER.options.skew + 2
        steps.lines(left, right, range(middle))
        threshold = random.choice((0, 100, 2000, 4000))
        config = CONFIG.override([f"compensation.threshold={threshold}"])
        steps.write("COMPENSATION", threshold)
        steps.lines(left, right, range(middle, height))
    steps.lines(*textured(2, CONFIG.min_width, 99), range(2))
    assert differ >= 2
    out = run(steps, tmp_path, seed=5, idle=0.3, pressure=0.2)
    assert len(out.frames) == len(wanted)
    for number, (want, got) in enumerate(zip(wanted, out.frames, strict=False)):
        assert np.array_equal(got, want), (number, np.argwhere(got != want)[:3])
    assert out.registers["FRAMES"] == len(wanted)
    assert out.registers["ALIGNMENT_LOSSES"] == 0
    assert out.registers["FLAGS"] & ~SKEW_FLAG == 1


SKEW_FLAG, ALIGNMENT_FLAG = 1 << 6, 1 << 5


def test_a_view_that_is_too_far_ahead_waits(tmp_path: Path) -> None:
    """The right one lacks its last lines: the left one is held, and says so."""
    left, right = textured(10, CONFIG.max_width, 3)
    steps = Steps(PAPER)
    for y in range(10):
        steps.view("left", left[y], y == 0)
    for y in range(4):
        steps.view("right", right[y], y == 0)
    out = run(steps, tmp_path)
    assert out.registers["FLAGS"] == SKEW_FLAG
    assert out.registers["STATUS"] == 1


@pytest.mark.parametrize("seed", range(4))
def test_broken_video_in_either(seed: int, tmp_path: Path) -> None:
    """As the synchroniser's model pairs the views, and the table of faults mends what they make."""
    views = broken_views(seed, CONFIG)
    rng = np.random.default_rng(seed)
    pixels = [rng.integers(0, 60, (len(view) + 1, 3), dtype=np.uint8) for view in views]
    steps = Steps(PAPER)
    for name, view, own in zip(("left", "right"), views, pixels, strict=True):
        begin = 0
        for k, sent in enumerate(view, start=1):
            if sent.eol:
                steps.view(name, own[[p.value for p in view[begin:k]]], *(p.sof for p in view[begin:k]))
                begin = k
    paired = joined(*views, skew=SKEW)
    stream: Stream = [Sent(k, pair.sof, pair.last) for k, pair in enumerate(paired.pairs)]
    found = mended(stream, CONFIG)
    out = run(steps, tmp_path, seed=seed, idle=0.2, pressure=0.1)
    closed = [frame for frame in found.frames if frame.end != "open"]
    assert len(out.frames) >= len(closed)
    for number, frame in enumerate(closed):
        chosen = np.array(frame.lines)
        sides = [own[np.array([pair[k] for pair in paired.pairs])[chosen]] for k, own in enumerate(pixels)]
        got = out.frames[number]
        assert np.array_equal(got & ~DAMAGED, results(*sides)), number
        marked = (got & DAMAGED != 0).ravel()
        due = np.array(frame.damaged[: marked.size])
        assert (marked | ~due).all()
        assert marked[-1] == frame.damaged[-1]
    registers = out.registers
    for name in ("short_lines", "long_lines", "early_starts", "missing_starts"):
        assert registers[name.upper()] == found.counters.get(name, 0), name
    assert registers["ALIGNMENT_LOSSES"] == paired.losses > 0
    assert registers["FLAGS"] & ALIGNMENT_FLAG
