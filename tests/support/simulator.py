"""A stand-in for the simulated gateware, where a test is about what is done with its results."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import pytest

from softdepth.golden import fixed_model
from softdepth.golden.maps import DisparityMap
from softdepth.sim import frames


def simulate_with_faults(monkeypatch: pytest.MonkeyPatch, faults: Mapping[tuple[int, int], int]) -> None:
    """Let the fixed model answer for the simulator, with bits of some pixels (y, x) turned over."""

    def run_frames(config: Any, pairs: Any, **_: Any) -> SimpleNamespace:
        maps = []
        for left, right in pairs:
            found = fixed_model.disparity(left, right, config)
            disparity = found.disparity.copy()
            for place, bits in faults.items():
                disparity[place] ^= bits
            maps.append(DisparityMap(disparity, found.code))
        stream = SimpleNamespace(seconds_sim=0.5)
        return SimpleNamespace(maps=maps, stream=stream, cycles_per_pixel=4.0, pixels_per_second=1000.0)

    monkeypatch.setattr(frames, "run_frames", run_frames)
