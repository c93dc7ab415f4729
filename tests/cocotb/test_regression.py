"""The gateware equals the fixed model: random configurations, awkward frames, any stall pattern."""

import pytest

from softdepth.hdl.built import missing
from softdepth.hdl.verilog import to_verilog
from softdepth.sim.stalls import Pauses, Stalls
from softdepth.spec.config import PRESETS, Config
from tests.cocotb.conftest import Exact
from tests.cocotb.scenes import SEEDS, frames_for, random_config, textured


@pytest.mark.parametrize("seed", SEEDS)
def test_random_configuration(seed: int, exact: Exact) -> None:
    config = random_config(seed)
    pairs = frames_for(config, seed)
    verilog = to_verilog(config)
    exact(config, pairs, verilog=verilog)
    probability = 0.2 + 0.6 * (seed % 4) / 3
    exact(config, pairs, verilog=verilog, stalls=Stalls.random(probability, seed))


@pytest.mark.parametrize("preset", [name for name in PRESETS if not missing(Config.preset(name))])
@pytest.mark.parametrize("operator", ["min", "mean"])
def test_presets_under_every_kind_of_stall(preset: str, operator: str, exact: Exact) -> None:
    if Config.preset(preset).cost == "sum" and operator == "min":
        pytest.skip("a sum has no operator")
    config = Config.preset(preset).override([f"operator={operator}", "disparities=16", "lanes=2"])
    pairs = frames_for(config, seed=100)[1:6]
    verilog = to_verilog(config)
    slow = Pauses("random", probability=0.6, seed=1)
    bursts = Pauses("bursts", probability=0.5, burst=300, seed=2)
    for stalls in (
        Stalls(),
        Stalls(input=slow),
        Stalls(output=slow),
        Stalls(input=bursts, output=slow),
        Stalls(output=Pauses(initial=5000)),
    ):
        exact(config, pairs, verilog=verilog, stalls=stalls)
    exact(config, pairs, verilog=verilog, gap=2000)


@pytest.mark.parametrize("lanes", [1, 4, 16, 64])
def test_lanes(lanes: int, exact: Exact) -> None:
    """From one lane to all of them, at the full 64 disparities, and at the rate that they promise."""
    config = Config.preset("lite" if lanes < 64 else "sad").override([f"lanes={lanes}"])
    pairs = [textured(9, 90, seed) for seed in range(3)]
    result = exact(config, pairs)
    # Between the first result and the last frame's last pixel nothing but pixels takes time.
    support = config.reach_rows * 90 + config.reach_right
    cycles = result.stream.cycles[: -support - 1]
    assert cycles[-1] - cycles[0] == config.steps * (len(cycles) - 1)


def test_frames_without_end_markers(exact: Exact) -> None:
    config = Config.preset("sad").override(["disparities=8", "lanes=2"])
    pairs = [textured(12, 40, seed) for seed in range(3)]
    verilog = to_verilog(config)
    exact(config, pairs, verilog=verilog, eof=False)
    exact(config, pairs, verilog=verilog, eof=False, stalls=Stalls.random(0.5, seed=4), gap=1000)
