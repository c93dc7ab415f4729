"""StereoCore on small frames, against the fixed model: every pixel, code and marker."""

from itertools import chain, pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from softdepth.golden.fixed_model import disparity, trace
from softdepth.golden.maps import DisparityMap
from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.core import StereoCore
from softdepth.hdl.costs.band_costs import BandCosts
from softdepth.hdl.front.front import Front
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.support.simulation import Transfers, config, pair, sad, stream_through

Images = NDArray[np.uint8]


def images(seed: int, width: int, height: int, shift: int = 2) -> tuple[Images, Images]:
    """A noisy texture, seen ``shift`` pixels apart; rows alternate between dim and bright."""
    rng = np.random.default_rng(seed)
    scene = rng.integers(0, 256, (height, width + shift, 3))
    scene[::2] //= 8  # many small differences, and ties
    noise = rng.integers(-20, 21, (2, height, width, 3))
    left, right = np.clip(np.stack((scene[:, :width], scene[:, shift:])) + noise, 0, 255).astype(np.uint8)
    return left, right


def transfers(left: Images, right: Images, *, eof: bool = True) -> list[int]:
    height, width, _ = left.shape

    def packed(pixel: NDArray[np.uint8]) -> int:
        red, green, blue = map(int, pixel)
        return red | green << 8 | blue << 16

    return [
        pair(
            packed(left[y, x]),
            packed(right[y, x]),
            sof=(x, y) == (0, 0),
            eol=x == width - 1,
            eof=eof and (x, y) == (width - 1, height - 1),
        )
        for y in range(height)
        for x in range(width)
    ]


def check(payloads: list[Any], expected: list[DisparityMap]) -> None:
    """All results of all frames, in order, undamaged."""
    assert len(payloads) == sum(found.code.size for found in expected)
    results = iter(payloads)
    for number, frame in enumerate(expected):
        height, width = frame.code.shape
        for y in range(height):
            for x in range(width):
                o = next(results)
                where = f"frame {number}, y={y} x={x}"
                assert (o.disparity, o.code) == (frame.disparity[y, x], frame.code[y, x]), where
                assert bool(o.sof) == ((x, y) == (0, 0)), where
                assert bool(o.eol) == (x == width - 1), where
                assert bool(o.eof) == ((x, y) == (width - 1, height - 1)), where
                assert not o.damaged, where


def run(c: Config, pairs: list[tuple[Images, Images]], **keys: Any) -> Transfers:
    return stream_through(StereoCore(c), list(chain.from_iterable(transfers(*p) for p in pairs)), **keys)


FUZZY = {"membership_bits": 6, "compensation": {"reading": "top", "from_disparity": 3, "threshold": 900}}
NEST = [sad(3, label_bits=9), sad(5, label_bits=11), sad(7, label_bits=12)]
ROW = [sad(3, dx, label_bits=10) for dx in (-2, 0, 2)]
CONFIGS: dict[str, Config] = {
    "sad, 1 lane": config(cost="sum", criteria=[sad(3)], disparities=8, lanes=1),
    "sad, 2 lanes, 3 steps": config(cost="sum", criteria=[sad(5)], disparities=6, lanes=2),
    "sad, a row computed, 4 stored": config(
        cost="sum", criteria=[sad(5)], disparities=6, lanes=2, stored_rows=4
    ),
    "sad, all lanes": config(cost="sum", criteria=[sad(3)], disparities=5, lanes=5),
    "sad, beside": config(cost="sum", criteria=[sad(3, 3)], disparities=6, lanes=3),
    "sad, nothing to the right": config(cost="sum", criteria=[sad(3, -1)], disparities=4, lanes=2),
    "sad, memory rings": config(cost="sum", criteria=[sad(3)], disparities=18, lanes=1),
    "lite, mean, 2 lanes, 3 steps": config(criteria=ROW, disparities=6, lanes=2, **FUZZY),
    "lite, min, all lanes": config(
        criteria=ROW, disparities=4, lanes=4, operator="min", stored_rows=1, **FUZZY
    ),
    "paper, mean, 1 lane": config(criteria=NEST, disparities=6, lanes=1, **FUZZY),
    "paper, mean, 3 stored rows": config(criteria=NEST, disparities=6, lanes=3, stored_rows=3, **FUZZY),
    "paper, min, 3 lanes": config(criteria=NEST, disparities=6, lanes=3, operator="min", rules="corrected"),
    "lite, prod, 2 lanes": config(criteria=ROW, disparities=6, lanes=2, operator="prod", **FUZZY),
    "lite, soft-min I, 3 lanes": config(criteria=ROW, disparities=6, lanes=3, operator="soft_min_1", **FUZZY),
    "lite, soft-min II, 2 lanes": config(
        criteria=ROW, disparities=6, lanes=2, operator="soft_min_2", **FUZZY
    ),
}


def pairs_for(c: Config) -> list[tuple[Images, Images]]:
    """Two frames of one size, one of a single support, and a wide one that has all candidates."""
    w, h = c.min_width, c.min_height
    return [
        images(1, w + 2, h + 1, 1),
        images(2, w + 2, h + 1, 3),
        images(3, w, h, 0),
        images(4, w + c.disparities + 1, h + 1, 2),
    ]


@pytest.mark.parametrize("stalls", [False, True])
@pytest.mark.parametrize("name", CONFIGS)
def test_equals_the_fixed_model(name: str, stalls: bool) -> None:
    c = CONFIGS[name]
    pairs = pairs_for(c)[2 * stalls :]
    rates = {"i_rate": 0.6, "o_rate": 0.5} if stalls else {}
    result = run(c, pairs, seed=7, **rates)
    expected = [disparity(*p, c) for p in pairs]
    check(result.payloads, expected)
    assert result.status == {}
    codes = {int(code) for frame in expected for code in np.unique(frame.code)}
    assert codes == {Validity.FULL, Validity.PARTIAL, Validity.BORDER}
    assert len({int(d) for frame in expected for d in np.unique(frame.disparity)}) > 2


@pytest.mark.parametrize("lanes", [2, 4])
def test_infinite_costs(lanes: int) -> None:
    """Soft-min I in few bits has denominators that vanish: through lanes, tree and sequence."""
    keys = {"operator": "soft_min_1", "softness": 0.4, "membership_bits": 3}
    criteria = [sad(3, dx, label_bits=7) for dx in (-2, 0, 2)]
    c = config(criteria=criteria, disparities=4, lanes=lanes, **keys)
    rng = np.random.default_rng(9)
    left, right = rng.integers(0, 18, (2, c.min_height + 3, c.min_width + 12, 3), dtype=np.uint8)
    expected = disparity(left, right, c)
    traces = [trace(left, right, c, int(x), int(y)) for y, x in np.argwhere(expected.valid)]
    infinite = [t.denominator == 0 for t in traces]
    assert sum(map(np.any, infinite)) > 5
    assert any(found[0] and not found.all() for found in infinite)  # the first to be held is such a one
    check(run(c, [(left, right)]).payloads, [expected])


@pytest.mark.parametrize("from_disparity", [2, 3, 4])
def test_compensation_begins_at_its_disparity(from_disparity: int) -> None:
    """The scene lies at disparity 3, and the rule fires wherever it may."""
    rule = {"reading": "top", "from_disparity": from_disparity, "threshold": 0}
    c = config(criteria=ROW, disparities=6, lanes=2, compensation=rule)
    pairs = [images(5, c.min_width + 7, c.min_height + 1, 3)]
    expected = [disparity(*p, c) for p in pairs]
    check(run(c, pairs).payloads, expected)
    assert bool((expected[0].disparity == 3).any()) == (from_disparity > 3)


@pytest.mark.parametrize("name", ["sad, 2 lanes, 3 steps", "sad, all lanes", "lite, mean, 2 lanes, 3 steps"])
def test_one_result_every_so_many_clocks(name: str) -> None:
    """From the first result to the last that a pixel brings, over lines and frames."""
    c = CONFIGS[name]
    pairs = [images(k, c.min_width + 2, c.min_height + 1) for k in range(3)]
    result = run(c, pairs)
    by_themselves = c.reach_rows * (c.min_width + 2) + c.reach_right
    given = result.given[: len(result.given) - by_themselves]
    assert {b - a for a, b in pairwise(given)} == {c.steps}
    # The queues before the sequencer fill at once; from then on a pixel is taken when one is done.
    front = Front(c)
    waiting = front.places + BandCosts(c).places
    assert {b - a for a, b in pairwise(result.taken[waiting:])} == {c.steps}
    assert {b - a for a, b in pairwise(result.taken[: front.places + 1])} == {2 // front.places}


@pytest.mark.parametrize("name", ["sad, 1 lane", "sad, all lanes", "lite, mean, 2 lanes, 3 steps"])
def test_latency_is_as_stated(name: str) -> None:
    c = CONFIGS[name]
    width, height = c.min_width + 2, c.min_height + 1
    dut = StereoCore(c)
    result = stream_through(dut, transfers(*images(1, width, height)), i_rate=0.02)
    behind = c.reach_rows * width + c.reach_right
    with_pixels = width * height - behind
    # Those that find the core idle do not wait in its queue.
    last = result.taken[behind:]
    waits = [b - a for a, b in pairwise(result.taken[behind - 1 :])]
    clocks = [result.given[k] - last[k] for k in range(with_pixels) if waits[k] > 3 * c.steps]
    assert len(clocks) > with_pixels // 2
    assert set(clocks) == {BandLatency.of(c).idle}


@pytest.mark.parametrize("name", ["sad, 1 lane", "sad, all lanes"])
def test_back_pressure_reaches_the_input(name: str) -> None:
    """Results are hardly taken: pixels wait outside as soon as the result queue is promised."""
    c = CONFIGS[name]
    pairs = pairs_for(c)[:2]
    dut = StereoCore(c)
    result = stream_through(dut, list(chain.from_iterable(transfers(*p) for p in pairs)), o_rate=0.05, seed=3)
    check(result.payloads, [disparity(*p, c) for p in pairs])
    behind = c.reach_rows * pairs[0][0].shape[1] + c.reach_right
    promised = [
        sum(t < given for t in result.taken) - behind - k
        for k, given in enumerate(result.given[: -behind - 1])
    ]
    # More wait before the sequencer. The last place is promised to the second of two in a row only.
    band = BandLatency.of(c)
    assert max(promised) - band.waiting in (band.results - 1, band.results)


@pytest.mark.parametrize("reset_at", [1, 33])
@pytest.mark.parametrize("name", ["sad, 2 lanes, 3 steps", "lite, mean, 2 lanes, 3 steps"])
def test_reset_in_a_frame(name: str, reset_at: int) -> None:
    c = CONFIGS[name]
    broken, *sound = pairs_for(c)
    sent = transfers(*broken)[:reset_at] + list(chain.from_iterable(transfers(*p) for p in sound[:2]))
    result = stream_through(StereoCore(c), sent, reset_at=reset_at)
    check(result.payloads[result.before_reset :], [disparity(*p, c) for p in sound[:2]])
    assert result.status == {}


def test_without_end_of_frame_markers() -> None:
    c = CONFIGS["sad, 2 lanes, 3 steps"]
    pairs = [images(k, c.min_width + 3, c.min_height + 1) for k in range(3)]
    sent = list(chain.from_iterable(transfers(*p, eof=False) for p in pairs))
    check(stream_through(StereoCore(c), sent).payloads, [disparity(*p, c) for p in pairs])


def test_the_frame_after_a_damaged_one_is_exact() -> None:
    c = CONFIGS["lite, mean, 2 lanes, 3 steps"]
    first, second, *rest = pairs_for(c)
    width = second[0].shape[1]
    sent = transfers(*second)
    del sent[width * 2 + 3]  # a short line
    result = stream_through(
        StereoCore(c), [*transfers(*first), *sent, *chain.from_iterable(transfers(*p) for p in rest)]
    )
    pixels = second[0][..., 0].size
    check(result.payloads[:pixels], [disparity(*first, c)])
    marked = [bool(o.damaged) for o in result.payloads[pixels : 2 * pixels]]
    assert marked == sorted(marked)
    assert marked[-1]
    check(result.payloads[2 * pixels :], [disparity(*p, c) for p in rest])
    assert result.status == {"short_lines": 1}


def test_a_support_of_one_row_is_summed_down_columns() -> None:
    """The sequencer of windows learns the width from the line before the first with results."""
    c = config(cost="sum", criteria=[sad(1)], disparities=3, lanes=1)
    pairs = [images(1, 9, 3), images(2, 6, 1)]
    check(run(c, pairs, o_rate=0.7).payloads, [disparity(*p, c) for p in pairs])


def test_frames_lower_than_the_support() -> None:
    c = CONFIGS["sad, 1 lane"]
    pairs = [images(k, 7, height) for k, height in enumerate((1, 2, 5, 1, 4))]
    check(run(c, pairs, o_rate=0.7).payloads, [disparity(*p, c) for p in pairs])
