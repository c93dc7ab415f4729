"""Cores without a border band equal the fixed model, whatever is configured, stalled, or broken."""

from collections.abc import Callable

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring

from softdepth.golden import fixed_model
from softdepth.hdl.costs import column_groups
from softdepth.hdl.costs.criteria import running_sums
from softdepth.hdl.post import median, rank
from softdepth.hdl.post import stages as post_stages
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.verilog import to_verilog
from softdepth.hdl.winners import whole_winners
from softdepth.sim.job import Job
from softdepth.sim.stalls import Stalls
from softdepth.sim.stream import run_stream
from softdepth.sim.transfers import pack_frame, split_frames, to_maps, unpack_results
from softdepth.spec.config import OPERATORS, Config
from tests.cocotb.conftest import Exact
from tests.cocotb.scenes import noise, random_whole_config, textured, whole_frames_for
from tests.cocotb.test_damage import CASES, no_start
from tests.support.counters import unpack_status

ROBUST = Config.preset("robust").override(["disparities=8", "lanes=4", "max_width=64", "max_height=64"])
PAIRS = [textured(14, 33, 1), noise(6, 20, 2), textured(3, 4, 3), textured(1, 5, 4), textured(9, 12, 5)]


def test_a_few_seeds_have_every_kind() -> None:
    drawn = [random_whole_config(seed) for seed in range(12)]
    assert {c.operator for c in drawn if c.cost == "fuzzy"} == set(OPERATORS)
    for some in (drawn[:6], drawn[6:]):
        assert {c.cost for c in some} == {"sum", "fuzzy"}
        assert {c.pixel.value for c in some} == {"rgb8", "gray8", "gray10", "gray12"}
        assert {np.sign(c.min_disparity) for c in some} == {-1, 0, 1}
        assert {c.reference for c in some} == {"left", "right"}
        assert {each.kind for c in some for each in c.criteria} == {"census", "gradient", "sad"}
        assert {sad.source for c in some for sad in c.sads} == {"colour", "gradient"}


@pytest.mark.parametrize(
    "seed",
    [*range(6), *(pytest.param(seed, marks=[pytest.mark.slow, pytest.mark.full]) for seed in range(6, 12))],
)
def test_random_configuration(seed: int, exact: Exact) -> None:
    config = random_whole_config(seed)
    pairs = whole_frames_for(config, seed)
    verilog = to_verilog(config)
    exact(config, pairs, verilog=verilog)
    exact(config, pairs, verilog=verilog, stalls=Stalls.random(0.2 + 0.1 * seed, seed), gap=100 * seed)


def test_frames_without_end_markers(exact: Exact) -> None:
    pairs = [textured(12, 40, seed) for seed in range(3)]
    exact(ROBUST, pairs, eof=False, stalls=Stalls.random(0.5, seed=4))


@pytest.fixture(scope="module")
def verilog() -> str:
    return to_verilog(ROBUST)


@pytest.mark.parametrize("break_it", CASES, ids=lambda case: case.__name__)
def test_the_frame_after_a_broken_one_is_exact(verilog: str, break_it: Callable) -> None:
    good = [textured(14, 33, seed) for seed in range(3)]
    sound = [pack_frame(*pair) for pair in good]
    transfers = np.concatenate([sound[0], break_it(sound[1]), sound[2]])
    result = run_stream(verilog, Job(transfers, Stalls.random(0.3, seed=8), patience=3000))
    assert not result.violations
    frames = split_frames(unpack_results(result.payloads, ROBUST))
    for number, index in ((0, 0), (-1, 2)):
        assert not frames[number]["damaged"].any()
        expected = fixed_model.disparity(*good[index], ROBUST)
        assert not list(expected.differences(to_maps([frames[number]], ROBUST)[0]))
    assert unpack_status(result.status)[CASES[break_it]] > 0
    if break_it is not no_start:
        assert frames[1]["damaged"][-1, -1], "the last result tells about the whole frame"


@pytest.mark.parametrize("place", [1, 5 * 33 + 17, 14 * 33])
def test_reset_in_mid_frame(verilog: str, place: int) -> None:
    good = [textured(14, 33, seed) for seed in range(3)]
    sound = [pack_frame(*pair) for pair in good]
    transfers = np.concatenate([sound[0][:place], *sound[1:]])
    result = run_stream(verilog, Job(transfers, Stalls.random(0.3, seed=8), resets=(place,), patience=3000))
    frames = split_frames(unpack_results(result.payloads[result.epochs == 1], ROBUST))
    assert len(frames) == 2
    for frame, pair in zip(frames, good[1:], strict=True):
        assert not list(fixed_model.disparity(*pair, ROBUST).differences(to_maps([frame], ROBUST)[0]))


def keep_running_sums(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sums go on from what the frame before left."""

    class Kept(running_sums.RunningSums):
        def elaborate(self, platform: object) -> Module:
            wrapped = Module()
            wrapped.submodules.inner = inner = running_sums.RunningSums(*self.arguments)
            for name in ("valid", "place", "outside", "new", "old"):
                wrapped.d.comb += getattr(inner, name).eq(getattr(self, name))
            wrapped.d.comb += self.o.eq(inner.o)
            return wrapped

        def __init__(self, *arguments) -> None:
            self.arguments = arguments
            super().__init__(*arguments)

    monkeypatch.setattr(column_groups, "RunningSums", Kept)


def take_the_next_right_winner(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check looks at the right pixel beside the one that was chosen: a slot too late."""

    right_winner = whole_winners.right_winner

    def late(*sizes):
        winner = right_winner(*sizes)
        winner.latency -= ROBUST.steps
        return winner

    monkeypatch.setattr(whole_winners, "right_winner", late)


def fill_across_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    """The last measurement of a line is still the nearest to the left on the next."""

    class Across(wiring.Component):
        def __init__(self, *sizes: int) -> None:
            # Room for a frame without a measurement: it is to be wrong, not to wait for ever.
            self.inner = Fill(*sizes[:2], 1024)
            super().__init__(self.inner.signature)

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.submodules.inner = inner = self.inner
            m.d.comb += [
                inner.i.valid.eq(self.i.valid),
                self.i.ready.eq(inner.i.ready),
                inner.i.payload.eq(self.i.payload),
                # The frame is one line to it: the true ends of lines take another way through.
                inner.i.payload.eol.eq(self.i.payload.eof),
                inner.i.payload.damaged.eq(self.i.payload.eol),
                self.o.valid.eq(inner.o.valid),
                inner.o.ready.eq(self.o.ready),
                self.o.payload.eq(inner.o.payload),
                self.o.payload.eol.eq(inner.o.payload.damaged),
                self.o.payload.damaged.eq(0),
            ]
            return m

    monkeypatch.setattr(post_stages, "Fill", Across)


def take_the_median_of_24(monkeypatch: pytest.MonkeyPatch) -> None:
    """The last sample is left out."""

    class Fewer(rank.LowerMedian):
        def __init__(self, samples: int, bits: int, *, all_kept: bool = False) -> None:
            self.fewer = samples == 25
            super().__init__(samples, bits, all_kept=all_kept and not self.fewer)

        def elaborate(self, platform: object) -> Module:
            m = super().elaborate(platform)
            if self.fewer:
                m.d.comb += self.keep.eq(2**24 - 1)
            return m

    monkeypatch.setattr(median, "LowerMedian", Fewer)


@pytest.mark.parametrize(
    ("fault", "stage"),
    [
        (keep_running_sums, "costs"),
        (take_the_next_right_winner, "check"),
        (fill_across_lines, "fill|post"),
        (take_the_median_of_24, "post"),
    ],
)
def test_fault_is_caught(
    fault: Callable, stage: str, verilog: str, exact: Exact, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact(ROBUST, PAIRS, verilog=verilog)
    with monkeypatch.context() as patched:
        fault(patched)
        broken = to_verilog(ROBUST)
    assert broken != verilog
    with pytest.raises(AssertionError, match=f"stage: .*({stage})"):
        exact(ROBUST, PAIRS, verilog=broken)
