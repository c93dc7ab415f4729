"""Broken input is counted, flagged and survived: the next good frame is exact."""

from collections.abc import Callable

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.hdl.verilog import to_verilog
from softdepth.sim import damage
from softdepth.sim.job import Job
from softdepth.sim.stalls import Stalls
from softdepth.sim.stream import StreamResult, run_stream
from softdepth.sim.transfers import Payloads, pack_frame, split_frames, to_maps, unpack_results
from softdepth.spec.config import Config
from tests.cocotb.scenes import textured
from tests.support.counters import unpack_status

HEIGHT, WIDTH = 14, 33
CONFIG = Config.preset("paper").override(["disparities=8", "lanes=2", "max_width=48", "max_height=40"])
GOOD = [textured(HEIGHT, WIDTH, seed) for seed in range(4)]


def shortened(f: Payloads) -> Payloads:
    return damage.drop_pixels(f, 5, 7)


def lengthened(f: Payloads) -> Payloads:
    return damage.add_pixels(f, 5, 7)


def first_line_overlong(f: Payloads) -> Payloads:
    return damage.add_pixels(f, 0, 60)


def first_line_too_narrow(f: Payloads) -> Payloads:
    return damage.drop_pixels(f, 0, WIDTH - 2)


def lines_run_together(f: Payloads) -> Payloads:
    return damage.drop_line_end(f, 6)


def cut_at_a_line(f: Payloads) -> Payloads:
    return damage.truncate(f, 9)


def cut_in_a_line(f: Payloads) -> Payloads:
    return damage.truncate(f, 9, 11)


def cut_in_the_first_line(f: Payloads) -> Payloads:
    return damage.truncate(f, 0, 11)


def start_in_the_middle(f: Payloads) -> Payloads:
    return damage.add_start(f, 7, 0)


def no_start(f: Payloads) -> Payloads:
    return damage.drop_start(f)


CASES: dict[Callable[[Payloads], Payloads], str] = {
    shortened: "short_lines",
    lengthened: "long_lines",
    first_line_overlong: "long_lines",
    first_line_too_narrow: "short_lines",
    lines_run_together: "long_lines",
    cut_at_a_line: "early_starts",
    cut_in_a_line: "early_starts",
    cut_in_the_first_line: "early_starts",
    start_in_the_middle: "early_starts",
    no_start: "missing_starts",
}


@pytest.fixture(scope="module")
def verilog() -> str:
    return to_verilog(CONFIG)


def run(verilog: str, transfers: Payloads, stalls: Stalls, resets: tuple[int, ...] = ()) -> StreamResult:
    result = run_stream(verilog, Job(transfers, stalls, resets=resets, patience=3000))
    assert not result.violations
    return result


def assert_exact(frame: np.ndarray, index: int) -> None:
    """``frame`` is the sound result of the good pair `index`."""
    assert not frame["damaged"].any()
    expected = fixed_model.disparity(*GOOD[index], CONFIG)
    assert not list(expected.differences(to_maps([frame], CONFIG)[0]))


@pytest.mark.parametrize("stalls", [Stalls(), Stalls.random(0.5, seed=8)], ids=["streaming", "stalls"])
@pytest.mark.parametrize("break_it", CASES, ids=lambda case: case.__name__)
@pytest.mark.parametrize("eof", [True, False], ids=["eof", "no_eof"])
def test_the_next_frame_is_exact(
    verilog: str, break_it: Callable[[Payloads], Payloads], eof: bool, stalls: Stalls
) -> None:
    good = [pack_frame(*pair, eof=eof) for pair in GOOD]
    # Without end marks a height is supposed from two frames, and confirmed by a third that is seen to end.
    transfers = np.concatenate([good[0], good[1], good[0], good[1], break_it(good[2]), good[3]])
    result = run(verilog, transfers, stalls)
    frames = split_frames(unpack_results(result.payloads, CONFIG))
    for frame, index in ((0, 0), (1, 1), (2, 0), (-1, 3)):
        assert_exact(frames[frame], index)
    status = unpack_status(result.status)
    assert status[CASES[break_it]] > 0
    # The last result tells about the whole frame.
    if break_it is not no_start:
        assert_exact(frames[3], 1)
        assert frames[4]["damaged"][-1, -1]
        return
    # Without its start nothing of it can be trusted: it is dropped. Without end marks it looks like more
    # lines of the frame before, which is too tall then.
    assert len(frames) == 5
    if eof:
        assert_exact(frames[3], 1)
    else:
        assert frames[3]["damaged"][-1, -1]


def test_sound_frames_count_nothing(verilog: str) -> None:
    transfers = np.concatenate([pack_frame(*pair) for pair in GOOD])
    result = run(verilog, transfers, Stalls.random(0.3, seed=1))
    assert set(unpack_status(result.status).values()) == {0}


@pytest.mark.parametrize("place", [1, WIDTH, 5 * WIDTH + 17, HEIGHT * WIDTH - 1, HEIGHT * WIDTH])
@pytest.mark.parametrize("stalls", [Stalls(), Stalls.random(0.6, seed=3)], ids=["streaming", "stalls"])
def test_reset_in_mid_frame(verilog: str, place: int, stalls: Stalls) -> None:
    frames_in = [pack_frame(*pair) for pair in GOOD]
    result = run(verilog, np.concatenate([frames_in[0][:place], *frames_in[1:]]), stalls, resets=(place,))
    after = unpack_results(result.payloads[result.epochs == 1], CONFIG)
    frames = split_frames(after)
    assert len(frames) == 3
    for index, frame in enumerate(frames, start=1):
        assert_exact(frame, index)
    assert set(unpack_status(result.status).values()) == {0}
