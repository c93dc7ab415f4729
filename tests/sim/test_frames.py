"""Whole frames: maps come back in the user's view, and a core at fault is not believed."""

from collections.abc import Callable

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.maps import DisparityMap
from softdepth.sim.compare import mismatches
from softdepth.sim.frames import run_frames
from softdepth.sim.stalls import Pauses, Stalls
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError, ToolError

Pair = tuple[np.ndarray, np.ndarray]
DesignOf = Callable[..., str]

NO_DESIGN = "not Verilog: an attempt to build this would be a ToolError"


def pairs_of(*shapes: tuple[int, int]) -> list[Pair]:
    rng = np.random.default_rng(11)
    return [tuple(rng.integers(0, 256, (2, *shape, 3), dtype=np.uint8)) for shape in shapes]


@pytest.mark.parametrize("reference", ["left", "right"])
def test_maps_are_in_the_users_view(
    reference: str, config: Config, stand_in: DesignOf, model: Callable
) -> None:
    config = config.override([f"reference={reference}"])
    pairs = pairs_of((9, 12), (8, 20), (9, 12))
    result = run_frames(config, pairs, verilog=stand_in(), stalls=Stalls.random(0.3, seed=1))
    assert len(result.maps) == 3
    for (left, right), found in zip(pairs, result.maps, strict=True):
        other = model(config, left, right) if reference == "left" else model(config, right, left)
        assert np.array_equal(found.disparity, other)


def test_maps_are_handed_over_while_the_session_goes_on(
    config: Config, stand_in: DesignOf, model: Callable
) -> None:
    pairs = pairs_of((9, 12), (8, 20), (9, 12))
    came: list[tuple[int, DisparityMap]] = []
    result = run_frames(
        config, pairs, verilog=stand_in(), handed=lambda number, found, _: came.append((number, found))
    )
    assert result.maps == []
    assert result.stream.clocks > 0
    assert [number for number, _ in came] == [0, 1, 2]
    for (left, right), (_, found) in zip(pairs, came, strict=True):
        assert np.array_equal(found.disparity, model(config, left, right))


def test_what_fails_at_a_map_fails_the_run(config: Config, stand_in: DesignOf) -> None:
    def refuse(number: int, found: DisparityMap, seconds: float) -> None:
        raise InputError(f"no frame {number}", "none")

    with pytest.raises(InputError, match="no frame 0"):
        run_frames(config, pairs_of((9, 12), (9, 12)), verilog=stand_in(), handed=refuse)


def test_measures_the_core_and_not_its_filling(config: Config, stand_in: DesignOf) -> None:
    steady = run_frames(config, pairs_of((9, 12)), verilog=stand_in())
    assert steady.cycles_per_pixel == config.steps
    assert 1 <= steady.latency <= 4
    blocked = run_frames(
        config, pairs_of((9, 12)), verilog=stand_in(), stalls=Stalls(output=Pauses(initial=200))
    )
    assert blocked.latency > 190
    assert steady.pixels_per_second > 0


def test_gaps_lie_between_the_frames(config: Config, stand_in: DesignOf) -> None:
    result = run_frames(config, pairs_of((8, 8), (8, 8), (8, 8)), verilog=stand_in(), gap=150)
    assert np.flatnonzero(np.diff(result.stream.taken) > 150).tolist() == [63, 127]


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("drops_valid", "o.valid fell before o.ready took the result, at clock"),
        ("loses_last", "it took 108 of 108 pixels, gave 107 of 108 results, and then nothing for"),
        ("repeats_last", "it gave 109 results where 108 were due"),
    ],
)
def test_does_not_believe_a_core_at_fault(
    fault: str, message: str, config: Config, stand_in: DesignOf
) -> None:
    stalls = Stalls(output=Pauses("random", 0.5)) if fault == "drops_valid" else None
    with pytest.raises(ToolError, match=message):
        run_frames(config, pairs_of((9, 12)), verilog=stand_in(fault), stalls=stalls)


@pytest.mark.parametrize(
    ("shapes", "eof", "message"),
    [
        ([], True, "no stereo pair"),
        ([(9, 12), (9, 65)], True, "65 pixels wide, the core takes 7 to 64.*max_width"),
        ([(9, 6)], True, "6 pixels wide, the core takes 7 to 64"),
        ([(65, 12)], True, "65 lines, the core takes 64.*max_height"),
        ([(9, 12), (9, 12)], False, "last of 2 pairs"),
        ([(9, 12), (9, 12), (10, 12)], False, r"heights \[9, 10\]"),
    ],
)
def test_refuses_bad_input_before_any_build(
    shapes: list[tuple[int, int]], eof: bool, message: str, config: Config
) -> None:
    with pytest.raises(InputError, match=message):
        run_frames(config, pairs_of(*shapes), verilog=NO_DESIGN, eof=eof)


@pytest.mark.slow
@pytest.mark.parametrize("eof", [True, False])
def test_the_core_agrees_with_the_fixed_model(config: Config, eof: bool) -> None:
    config = config.override(["disparities=4", "lanes=2"])
    pairs = pairs_of((9, 12), (9, 14), (9, 12))
    result = run_frames(config, pairs, stalls=Stalls.random(0.3, seed=4), eof=eof)
    assert mismatches([fixed_model.disparity(*pair, config) for pair in pairs], result.maps) == []
