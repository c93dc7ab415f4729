"""The quick regression: short runs that between them ask for all that a core does.

What is due is the fixed model's, and for broken video the fault table's. Nothing is taken from the gateware.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import chain
from random import Random

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.fixed_model import disparity
from softdepth.golden.front.pair import Image
from softdepth.golden.maps import DisparityMap
from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.signatures import Status, result_layout
from softdepth.sim.trials import WAITS, Due, Trial
from softdepth.spec.config import Config
from tests.cocotb.scenes import checkerboard, flat, noise, textured
from tests.support.broken_video import Stream, broken_video, good_frame, numbered
from tests.support.fault_table import Sent, mended
from tests.support.frames import Frame
from tests.support.simulation import pair

BROKEN = 40
"""Runs of broken video."""
CUT = 24
"""Runs that a reset ends anywhere."""
PALE = 8
"""Runs of next to no contrast."""
FEWER = 4
"""By this are these divided where less will do."""
FAULTS = (255, 257)
"""Of two runs the frames with every fault that is counted. Where one of a counter's bits turns
another, it has done so an odd number of times at the first if it does at 1, at the second if at 0."""
SPECKLED = 8
"""Runs of pictures with specks that only one view has."""
SHORTENED = 8
"""Runs of frames whose lines end anywhere."""
PAUSED = ("slow source", "slow sink", "both slow", "waiting sink")
PAUSES = {
    "full rate": (0, 0),
    "slow source": (700, 0),
    "slow sink": (0, 900),
    "both slow": (400, 400),
    "waiting sink": (200, WAITS),
}
"""Shares of clocks in which the source offers nothing and the sink takes nothing, in 1024ths."""

Pair = tuple[Image, Image]


def regression(config: Config, seed: int = 0, *, thorough: bool = True) -> list[Trial]:
    """The trials of a core of `config`, from a fixed seed; without `thorough`, a quarter of them.

    The first are sound video at full rate, which finds most faults.
    """
    fewer = 1 if thorough else FEWER
    trials = [
        full_rate(config, sizes(config)[0], seed),
        full_rate(config, (config.max_width, config.min_height + 2), seed + 10),
        *(paused(config, name, seed + 20 + k) for k, name in enumerate(PAUSED)),
    ]
    random = Random(seed)
    for k in range(CUT // fewer):
        # Ended by the reset anywhere, and then a whole one: it must not know of what was before.
        frames = scenes(config, small(config), seed + 40 + k)
        first = sound(config, frames, pauses=("full rate", "both slow")[k % 2], seed=seed + k)
        trials.append(replace(first, cut=random.randrange(1, len(first.sent) * config.steps)))
        trials.append(full_rate(config, small(config)[0], seed + 60 + k))
    rates = ("full rate", "both slow", "slow sink")
    for k in range(BROKEN // fewer):
        trials.append(broken(config, broken_video(seed + k, config)[0], seed + k, rates[k % 3]))
    trials += [broken(config, unmarked(config, seed + k), seed + k, rates[k]) for k in range(2)]
    trials.append(broken(config, marked_later(config), seed))
    trials += [pale(config, seed + 80 + k) for k in range(PALE // fewer)]
    trials += [broken(config, counted(config, times // fewer), seed) for times in FAULTS]
    trials.append(broken(config, overfull(config), seed))
    trials += [speckled(config, seed + 100 + k) for k in range(SPECKLED // fewer)]
    trials += [broken(config, shortened(config, seed + k), seed + k) for k in range(SHORTENED // fewer)]
    return trials


def pale(config: Config, seed: int) -> Trial:
    """Next to no contrast, and views apart by no, little or much light: the least bits of sums decide."""
    rng = np.random.default_rng(seed)
    shape = (2, config.max_height, config.max_width, config.pixel.channels)
    frames = []
    for contrast in (3, 6, 12, 24):
        left, right = rng.integers(0, contrast, shape)
        frames.append((left.astype(np.uint8), (right + rng.integers(0, 232)).astype(np.uint8)))
        frames.append((left.astype(np.uint8), right.astype(np.uint8)))
    return sound(config, frames, seed=seed)


def speckled(config: Config, seed: int) -> Trial:
    """Next to no contrast, but specks in one view: all candidates cost much, and the least bits decide."""
    rng = np.random.default_rng(seed)
    shape = (config.max_height, config.max_width, config.pixel.channels)
    frames = []
    for share in (0.02, 0.05, 0.1):
        for contrast in (2, 6):
            left, right = rng.integers(0, contrast, (2, *shape))
            specks = rng.random(shape[:2]) < share
            left[specks] += rng.integers(0, 256 - contrast, (np.count_nonzero(specks), 1))
            frames.append((left.astype(np.uint8), right.astype(np.uint8)))
    return sound(config, frames, seed=seed)


def shortened(config: Config, seed: int) -> Stream:
    """Frames of the largest size, of whose lines many end anywhere: these are filled with what came last."""
    random = Random(seed)
    frames = []
    for _ in range(3):
        frame = good_frame(config.max_width, config.max_height, eof=True)
        lines = [frame[at : at + config.max_width] for at in range(0, len(frame), config.max_width)]
        for line in lines[1:-1]:
            if random.random() < 0.7:
                del line[random.randrange(config.max_width - 1) : -1]
        frames += chain.from_iterable(lines)
    return frames


def unmarked(config: Config, seed: int) -> Stream:
    """Frames without an end, of each height three, higher ones than the core takes among them; one begins."""
    random = Random(seed)
    most = config.max_height
    heights = [*random.sample(range(1, most + 1), 5), most - 1, 2 * most + 3, most - 2, most + 1]
    width = config.min_width + seed
    frames = [frame for height in heights for frame in [good_frame(width, height, eof=False)] * 3]
    return [*chain.from_iterable(frames), *good_frame(width, 1, eof=False)]


def marked_later(config: Config) -> Stream:
    """A source that marks its ends once its height was learnt, and then changes it."""
    width, height = config.min_width + 1, config.max_height // 2
    learnt = good_frame(width, height, eof=False) * 3
    return [*learnt, *chain.from_iterable(good_frame(width, height + k, eof=True) for k in (0, 2, 1))]


def overfull(config: Config) -> Stream:
    """Frames as high as can be, of whose last lines one is short, one long, and all without an end."""
    width = config.min_width + 1
    frame = good_frame(width, config.max_height, eof=False)
    short, long = [*frame[:-2], frame[-1]], [*frame[:-1], Sent(0), frame[-1]]
    return [*short, *frame, *long, *good_frame(width, 1, eof=True)]


def counted(config: Config, times: int) -> Stream:
    """Time and again a long line, an early start, a short line, and a pixel outside any frame."""
    one = [Sent(0, sof=True), *[Sent(0)] * config.max_width, Sent(0, sof=True, eof=True), Sent(0)]
    return one * times


def sizes(config: Config) -> list[tuple[int, int]]:
    """Widths and heights: odd, smallest, wide and high."""
    w, h = config.min_width, config.min_height
    return [
        (min(w + config.disparities + 3, config.max_width), min(h + 3, config.max_height)),
        (w, h),
        (config.max_width, h + 1),
        (w + 1, config.max_height),
    ]


def small(config: Config) -> list[tuple[int, int]]:
    """Two frames that are over soon."""
    return [(config.min_width + 2, config.min_height), (config.min_width, config.min_height + 1)]


def scenes(config: Config, of: Sequence[tuple[int, int]], seed: int) -> list[Pair]:
    """Pairs of these sizes, of every kind in turn."""
    kinds = (textured, noise, opposed)
    frames = [kinds[k % 3](height, width, seed + k) for k, (width, height) in enumerate(of)]
    width, height = of[0]
    return [*frames, checkerboard(height, width), flat(height, width, 255 * (seed % 2))]


def opposed(height: int, width: int, seed: int) -> Pair:
    """One view dark and the other bright, and a spread of sums from low to the largest."""
    rng = np.random.default_rng(seed)
    spread = rng.integers(0, 256, (height, width, 1))
    left, right = rng.integers(0, 64, (2, height, width, 3))
    return (left * spread // 255).astype(np.uint8), (255 - (right + 192) * spread // 255).astype(np.uint8)


def full_rate(config: Config, size: tuple[int, int], seed: int) -> Trial:
    """Frames of one size without a pause, which must not take longer than is said of the core."""
    trial = sound(config, scenes(config, [size] * 3, seed), seed=seed)
    return trial if config.whole_frame else replace(trial, limit=last_clock(config, size[0], len(trial.sent)))


@cache
def last_clock(config: Config, width: int, pixels: int) -> int:
    """When the last result is there at the latest: nothing takes longer than a pixel's steps."""
    behind = config.reach_rows * width + config.reach_right
    return (pixels - 1 + behind) * config.steps + BandLatency.of(config).full_rate


def paused(config: Config, pauses: str, seed: int) -> Trial:
    """Sound video with pauses."""
    return sound(config, scenes(config, sizes(config), seed), pauses=pauses, seed=seed)


def sound(config: Config, frames: Sequence[Pair], *, pauses: str = "full rate", seed: int = 0) -> Trial:
    """Sound frames, ended by their markers."""
    sent, due = [], []
    for left, right in frames:
        height, width = left.shape[:2]
        pixels = good_frame(width, height, eof=True)
        for k, pixel in enumerate(pixels):
            y, x = divmod(k, width)
            sent.append(packed(left[y, x], right[y, x], pixel.sof, pixel.eol, pixel.eof))
        due += results(config, disparity(left, right, config), [False] * (height * width))
    i_pause, o_pause = PAUSES[pauses]
    return Trial(sent, due, status=0, i_pause=i_pause, o_pause=o_pause, seed=seed)


def broken(config: Config, stream: Stream, seed: int, pauses: str = "full rate") -> Trial:
    """Video of which every pixel may have any marker."""
    # The bench pauses at random only: silences that are meant are left out, here and in the table.
    stream = [pixel._replace(pause=False) for pixel in numbered(stream)]
    colours = colours_of(stream, seed)
    sent = [packed(*colours[pixel.value], pixel.sof, pixel.eol, pixel.eof) for pixel in stream]
    table = mended(stream, config)
    complete = [frame for frame in table.frames if frame.end != "open"]
    due = list(chain.from_iterable(mended_results(config, frame, colours) for frame in complete))
    i_pause, o_pause = PAUSES[pauses]
    return Trial(
        sent,
        due,
        status=Status.const(table.counters).as_bits(),
        exact=len(complete) == len(table.frames),
        i_pause=i_pause,
        o_pause=o_pause,
        seed=seed,
    )


def colours_of(stream: Stream, seed: int) -> NDArray[np.uint8]:
    """A left and a right pixel by number; many of them alike."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, rng.integers(2, 256), (len(stream) + 1, 2, 3)).astype(np.uint8)


def mended_results(config: Config, frame: Frame, colours: NDArray[np.uint8]) -> Iterator[Due]:
    """A mended frame's results; damage is that of the pixel with which each leaves, or of the end."""
    views = colours[np.array(frame.lines)]
    found = disparity(views[:, :, 0], views[:, :, 1], config)
    height, width = found.code.shape
    if config.whole_frame:
        # Where in a frame its damage begins to show is not said; its last result tells.
        damaged: list[bool | None] = [None if any(frame.damaged) else False] * (height * width)
        damaged[-1] = frame.damaged[-1]
    else:
        behind = config.reach_rows * width + config.reach_right
        count = height * width
        damaged = [frame.damaged[k + behind if k + behind < count else -1] for k in range(count)]
    yield from results(config, found, damaged)


def results(config: Config, found: DisparityMap, damaged: Sequence[bool | None]) -> Iterator[Due]:
    """The packed results of a map; None: whether it is damaged is not said."""
    layout = result_layout(config)
    height, width = found.code.shape
    everything = (1 << layout.size) - 1
    for k in range(height * width):
        y, x = divmod(k, width)
        fields = {
            "disparity": int(found.disparity[y, x]),
            "code": int(found.code[y, x]),
            "sof": k == 0,
            "eol": x == width - 1,
            "eof": k == height * width - 1,
            "damaged": bool(damaged[k]),
        }
        if found.confidence is not None:
            fields["confidence"] = int(found.confidence[y, x])
        mask = everything if damaged[k] is not None else everything & ~(1 << layout["damaged"].offset)
        yield Due(layout.const(fields).as_bits(), mask)


def packed(left: NDArray[np.uint8], right: NDArray[np.uint8], sof: bool, eol: bool, eof: bool) -> int:
    """The bits of an RGB pair."""
    words = (int(red) | int(green) << 8 | int(blue) << 16 for red, green, blue in (left, right))
    return pair(*words, sof=sof, eol=eol, eof=eof)
