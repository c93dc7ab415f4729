"""StereoCore with other pixels than RGB of 8 bits, and candidates that do not begin at 0."""

from itertools import chain

import numpy as np
import pytest
from numpy.typing import NDArray

from softdepth.golden.fixed_model import disparity, trace
from softdepth.golden.maps import DisparityMap
from softdepth.hdl.core import StereoCore
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config, PixelFormat
from softdepth.spec.validity import Validity
from tests.hdl.test_core import check
from tests.support.simulation import config, sad, stream_through

Images = tuple[NDArray[np.generic], NDArray[np.generic]]


def images(c: Config, seed: int, shift: int, extra: int = 8) -> Images:
    """A texture of the configuration's pixels, seen `shift` pixels apart; all values occur."""
    rng = np.random.default_rng(seed)
    height, width = c.min_height + 1, c.min_width + c.disparities + extra
    scene = rng.integers(0, c.pixel.maximum + 1, (height, width + abs(shift), c.pixel.channels))
    scene[::2] >>= 3
    first = max(-shift, 0)
    left, right = scene[:, first : first + width], scene[:, first + shift :][:, :width]
    pair = np.stack((left, right)) + rng.integers(0, 3, (2, height, width, c.pixel.channels))
    pair = np.minimum(pair, c.pixel.maximum).astype(np.uint8 if c.pixel.bits == 8 else np.uint16)
    return (pair[0, ..., 0], pair[1, ..., 0]) if c.pixel.channels == 1 else (pair[0], pair[1])


def run(c: Config, pairs: list[Images]) -> list[DisparityMap]:
    """The fixed model's maps, after all results of the gateware have been compared with them."""
    frames = [pack_frame(left, right, pixel=c.pixel).tolist() for left, right in pairs]
    result = stream_through(StereoCore(c), list(chain.from_iterable(frames)), i_rate=0.8, o_rate=0.7)
    expected = [disparity(left, right, c) for left, right in pairs]
    check(result.payloads, expected)
    return expected


NEST = {"criteria": [sad(1, 1, 9), sad(3, 0, 11), sad(5, -1, 13)], "disparities": 6, "lanes": 3}


@pytest.mark.parametrize("stored", [0, 2, 4])
@pytest.mark.parametrize("pixel", list(PixelFormat))
def test_pixels(pixel: PixelFormat, stored: int) -> None:
    c = config(pixel=pixel, stored_rows=stored, **NEST)
    (expected,) = run(c, [images(c, 3, 2)])
    assert len(np.unique(expected.disparity)) > 2


@pytest.mark.parametrize("pixel", ["gray8", "rgb12"])
def test_the_extremes_of_pixels(pixel: str) -> None:
    """White against black, and the other way round."""
    c = config(pixel=pixel, cost="sum", criteria=[sad(3)], disparities=4, lanes=2)
    left, right = images(c, 5, 0)
    left[:], right[:] = 0, 0
    left[:, ::3], right[:, 1::2] = c.pixel.maximum, c.pixel.maximum
    run(c, [(left, right), (right, left)])


@pytest.mark.parametrize("first", [-20, -3, 2, 17])
def test_candidates_from(first: int) -> None:
    rule = {"reading": "top", "from_disparity": first + 2, "threshold": 900}
    c = config(min_disparity=first, pixel="gray8", max_width=64, compensation=rule, **NEST)
    c = c.override(["compensation.criterion=2"])
    pairs = [images(c, 7, first + 3), images(c, 8, first + 1)]
    expected = run(c, pairs)
    for found in expected:
        assert set(np.unique(found.code)) == {Validity.FULL, Validity.PARTIAL, Validity.BORDER}
        assert found.disparity[found.valid].min() >= first
        assert found.disparity[found.valid].max() <= first + c.disparities - 1
        assert (found.disparity[~found.valid] == 0).all()
    apart = expected[0].disparity[expected[0].code == Validity.FULL]
    assert np.median(apart) == first + 3


def test_a_trace_counts_from_the_first_candidate() -> None:
    c = config(min_disparity=-3, pixel="gray10", **NEST)
    left, right = images(c, 2, 1)
    found = disparity(left, right, c)
    for y, x in np.argwhere(found.code >= 0)[::5]:
        seen = trace(left, right, c, int(x), int(y))
        assert (seen.disparity, seen.code) == (found.disparity[y, x], found.code[y, x])
        if seen.code < Validity.BORDER:
            assert seen.first + seen.winner == seen.disparity
