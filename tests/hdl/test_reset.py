"""A reset at any clock of a frame: the frame that follows it is exact, as if nothing had been before.

Random bits are in all registers that a reset leaves, and in the memories, from the start.
"""

from dataclasses import replace

import pytest

from softdepth.hdl import verilog
from softdepth.hdl.front import front
from softdepth.sim.trials import Trial, Verdict, run_trials
from softdepth.spec.config import Config
from tests.cocotb.scenes import noise, textured
from tests.mutation.regression import sound
from tests.mutation.study import CORES
from tests.support.mutations import COLUMNS, mutated_guard

CLOCKS = 400
"""Of a run that is ended by a reset after its first clock, its second, and so on."""


def config_of(name: str) -> Config:
    return Config.from_dict({"name": name, **CORES[name]})


def runs(config: Config, pauses: str) -> list[Trial]:
    """A frame cut at each clock, and a whole one after each, of another size: old lines would show."""
    w, h = config.min_width, config.min_height
    first = sound(config, [textured(h, w + 2, 1), noise(h + 1, w + 4, 2)], pauses=pauses, seed=3)
    then = sound(config, [noise(h, w + 1, 3)], seed=4)
    cut = (replace(first, cut=clock, seed=clock) for clock in range(1, CLOCKS))
    return [trial for each in cut for trial in (each, then)]


def after_resets(config: Config) -> Verdict:
    """The first trial that fails, if any."""
    trials = [trial for pauses in ("full rate", "both slow") for trial in runs(config, pauses)]
    return run_trials(verilog.to_verilog(config), trials)[0]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sad", "robust"])
def test_a_frame_after_a_reset_at_any_clock_is_exact(name: str) -> None:
    found = after_resets(config_of(name))
    assert found.trial is None, (found, "a cut run and what follows it take turns")
    assert found.clocks > CLOCKS**2, "it was not cut"


@pytest.mark.slow
def test_a_register_that_should_be_reset_is_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A frame's width that is left from two pixels of another makes lines of two pixels, for ever."""
    kept = "second_last = Signal.like(x, init=config.max_width - 2"
    broken = mutated_guard(COLUMNS, kept, f"{kept}, reset_less=True")
    monkeypatch.setattr(front, "FrameGuard", broken)
    assert after_resets(config_of("sad")).wrong
