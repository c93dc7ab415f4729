"""The bench moves every transfer, under any stalls, and notices what a design does wrong."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from softdepth.sim.job import Job
from softdepth.sim.stalls import Pauses, Stalls
from softdepth.sim.stream import StreamResult, run_stream
from softdepth.sim.transfers import Payloads, pack_frame, unpack_results
from softdepth.spec.config import Config
from softdepth.spec.errors import ToolError
from tests.support.counters import unpack_status

LINES, WIDTH = 9, 12
PIXELS = LINES * WIDTH

DesignOf = Callable[..., str]


@pytest.fixture
def transfers(pair: tuple[np.ndarray, np.ndarray]) -> Payloads:
    return pack_frame(*pair)


@pytest.fixture
def disparities(config: Config, pair: tuple[np.ndarray, np.ndarray], model: Callable) -> np.ndarray:
    return model(config, *pair).reshape(-1)


def got(result: StreamResult, config: Config) -> np.ndarray:
    return unpack_results(result.payloads, config)["disparity"]


SIDES = {
    "none": Stalls(),
    "random": Stalls.random(0.6, seed=1),
    "bursts": Stalls.bursts(0.6, seed=2, burst=30),
    "slow sink": Stalls(output=Pauses("random", 0.8, seed=3)),
    "slow source": Stalls(input=Pauses("random", 0.8, seed=3)),
}


@pytest.mark.parametrize("name", SIDES)
def test_stalls_change_the_time_and_nothing_else(
    name: str, stand_in: DesignOf, transfers: Payloads, disparities: np.ndarray, config: Config
) -> None:
    job = Job(transfers, SIDES[name], expected=PIXELS)
    result = run_stream(stand_in(), job)
    assert result.complete
    assert result.violations == ()
    assert np.array_equal(got(result, config), disparities)
    assert unpack_status(result.status)["short_lines"] == LINES
    assert len(result.taken) == PIXELS
    span = result.cycles[-1] - result.cycles[0]
    if name == "none":
        assert span == config.steps * (PIXELS - 1)
    else:
        assert span > 1.3 * config.steps * (PIXELS - 1)
        again = run_stream(stand_in(), job)
        assert np.array_equal(again.cycles, result.cycles)
        assert np.array_equal(again.taken, result.taken)


def test_a_sink_that_blocks_at_first(stand_in: DesignOf, transfers: Payloads) -> None:
    job = Job(transfers, Stalls(output=Pauses(initial=400)), expected=PIXELS, patience=100)
    result = run_stream(stand_in(), job)
    assert result.complete
    assert result.cycles[0] > 400
    assert np.sum(result.taken < 400) < 12  # back-pressure: the FIFO filled up


def test_the_source_waits_in_a_gap(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in(), Job(transfers, gaps={50: 333}, expected=PIXELS))
    assert result.complete
    intervals = np.diff(result.taken)
    assert intervals[49] == 333 + 1
    assert np.sum(intervals > 2) == 1


@pytest.mark.parametrize(
    ("fault", "rule"), [("drops_valid", "o.valid fell"), ("changes_payload", "o.payload changed")]
)
def test_catches_broken_stream_rules(fault: str, rule: str, stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in(fault), Job(transfers, SIDES["random"], expected=PIXELS))
    assert result.violations
    assert all(rule in violation.rule for violation in result.violations)
    assert result.violations[0].cycle > result.taken[0]


def test_a_reset_in_mid_frame(
    stand_in: DesignOf, transfers: Payloads, disparities: np.ndarray, config: Config
) -> None:
    first = 2 * WIDTH + 5
    job = Job(transfers, SIDES["slow sink"], resets=(first,), expected=PIXELS - first)
    result = run_stream(stand_in(), job)
    assert result.complete
    assert result.violations == ()
    before, after = result.epochs == 0, result.epochs == 1
    assert 0 < np.sum(before) < first  # the FIFO's content is lost
    assert np.array_equal(got(result, config)[before], disparities[: np.sum(before)])
    assert np.array_equal(got(result, config)[after], disparities[first:])
    assert unpack_status(result.status)["short_lines"] == LINES - 2


def test_resets_at_both_ends(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in(), Job(transfers, resets=(PIXELS, 0), expected=0))
    assert result.complete
    assert set(result.epochs.tolist()) == {1}
    assert unpack_status(result.status)["short_lines"] == 0


def test_stops_when_nothing_moves(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in("hangs"), Job(transfers, expected=PIXELS, patience=300))
    assert not result.complete
    assert len(result.taken) == len(result.payloads) == 20
    assert 300 < result.clocks < 500


def test_a_lost_result(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in("loses_last"), Job(transfers, expected=PIXELS, patience=300))
    assert not result.complete
    assert len(result.payloads) == PIXELS - 1


def test_a_surplus_result(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in("repeats_last"), Job(transfers, expected=PIXELS))
    assert result.complete
    assert len(result.payloads) == PIXELS + 1


def test_runs_until_quiet_without_an_expectation(stand_in: DesignOf, transfers: Payloads) -> None:
    result = run_stream(stand_in("loses_last"), Job(transfers, patience=300))
    assert result.complete
    assert len(result.payloads) == PIXELS - 1


def test_no_transfers(stand_in: DesignOf) -> None:
    result = run_stream(stand_in(), Job(np.zeros(0, np.uint64), expected=0))
    assert result.complete
    assert len(result.payloads) == 0


def test_reports_progress(stand_in: DesignOf, transfers: Payloads) -> None:
    seen: list[int] = []
    frames = 400
    result = run_stream(
        stand_in(), Job(np.tile(transfers, frames), expected=frames * PIXELS), progress=seen.append
    )
    assert result.complete
    assert seen == sorted(seen)
    assert 0 < seen[0] < seen[-1] <= frames * PIXELS


@pytest.fixture
def _logs_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A failed run leaves its log; a test that fails on purpose leaves it in its own folder."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


@pytest.mark.usefixtures("_logs_elsewhere")
def test_a_bench_that_fails_is_one_line(stand_in: DesignOf, transfers: Payloads) -> None:
    design = stand_in().replace("status", "something")
    with pytest.raises(ToolError, match=r"the simulator stopped: .*status.*see ") as caught:
        run_stream(design, Job(transfers, expected=PIXELS))
    assert "status" in Path(caught.value.remedy.removeprefix("see ")).read_text()


@pytest.mark.usefixtures("_logs_elsewhere")
def test_a_design_that_ends_the_simulation(stand_in: DesignOf, transfers: Payloads) -> None:
    design = stand_in().replace("endmodule", "always @(posedge clk) if (i_valid) $finish; endmodule", 1)
    with pytest.raises(ToolError, match="the simulator stopped"):
        run_stream(design, Job(transfers, expected=PIXELS))


@pytest.mark.slow
def test_waves_show_the_inside(stand_in: DesignOf, transfers: Payloads, tmp_path: Path) -> None:
    path = tmp_path / "run.vcd"
    plain = run_stream(stand_in(), Job(transfers, expected=PIXELS))
    traced = run_stream(stand_in(), Job(transfers, expected=PIXELS), waves=path)
    assert np.array_equal(plain.payloads, traced.payloads)
    header = path.read_text().partition("$enddefinitions")[0]
    assert "fifo" in header
